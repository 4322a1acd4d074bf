# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D OUTPUT=report_page.hpp -P embed.cmake
# page.html with its style and scripts put in, as a C++ header.

cmake_minimum_required(VERSION 3.21)
set(folder ${CMAKE_CURRENT_LIST_DIR})

file(READ ${folder}/page.html page)
file(READ ${folder}/style.css style)
set(script "")
foreach(part IN ITEMS draw charts mesh resolution main)
    file(READ ${folder}/${part}.js text)
    string(APPEND script "${text}\n")
endforeach()
string(REPLACE "@STYLE@" "${style}" page "${page}")
string(REPLACE "@SCRIPT@" "${script}" page "${page}")

# Compilers limit how long a literal may be, but not what adjacent ones add up to.
set(literals "")
string(LENGTH "${page}" length)
set(at 0)
while(at LESS length)
    string(SUBSTRING "${page}" ${at} 8000 piece)
    string(APPEND literals "    R\"page(${piece})page\"\n")
    math(EXPR at "${at} + 8000")
endwhile()

file(WRITE ${OUTPUT} "// Made by examples/report/embed.cmake.
#pragma once

namespace example {

inline constexpr char report_page[] =
${literals}    ;

}  // namespace example
")
