# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D OUTPUT=taut_single.hpp [-D ALSO="bdf2/bdf2.hpp;..."] -P scripts/single_header.cmake
# Writes include/taut/taut.hpp, and the modules' headers of ALSO, with all that they include into one
# file: each header once, where it is first included. The same sources give the same bytes.
cmake_minimum_required(VERSION 3.21)

if(NOT OUTPUT)
    message(FATAL_ERROR "single_header: say where to write: -D OUTPUT=taut_single.hpp")
endif()
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH root)
set(include_dir ${root}/include/taut)
set(text "")  # of the single header so far; never a list: code has semicolons and brackets
set(seen "")

function(append_header header)
    if(header IN_LIST seen)
        return()
    endif()
    if(NOT EXISTS ${include_dir}/${header})
        message(FATAL_ERROR "single_header: there is no include/taut/${header}")
    endif()
    list(APPEND seen ${header})
    cmake_path(GET header PARENT_PATH folder)
    file(READ ${include_dir}/${header} rest)
    string(REGEX REPLACE "^// SPDX-FileCopyrightText[^\n]*\n// SPDX-License[^\n]*\n" "" rest "${rest}")
    string(REGEX REPLACE "^#pragma once\n" "" rest "${rest}")
    string(APPEND text "\n// ---- ${header} ----\n")
    set(rest "\n${rest}")
    while(rest MATCHES "\n#include \"([^\"]*)\"[^\n]*")
        set(line "${CMAKE_MATCH_0}")
        set(included "${CMAKE_MATCH_1}")
        string(FIND "${rest}" "${line}" at)
        string(SUBSTRING "${rest}" 0 ${at} before)
        string(LENGTH "${line}" length)
        math(EXPR at "${at} + ${length}")
        string(SUBSTRING "${rest}" ${at} -1 rest)
        string(APPEND text "${before}")
        cmake_path(APPEND folder "${included}" OUTPUT_VARIABLE included)
        cmake_path(NORMAL_PATH included)
        append_header("${included}")
    endwhile()
    string(APPEND text "${rest}")
    set(text "${text}" PARENT_SCOPE)
    set(seen "${seen}" PARENT_SCOPE)
endfunction()

append_header(taut.hpp)
foreach(header IN LISTS ALSO)
    append_header(${header})
endforeach()
string(REGEX REPLACE "\n\n\n+" "\n\n" text "${text}")

file(READ ${root}/LICENSE licence)
string(STRIP "${licence}" licence)
string(REPLACE "\n" "\n// " licence "// ${licence}")
string(REGEX REPLACE " +\n" "\n" licence "${licence}\n")
file(WRITE ${OUTPUT} "// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Taut in one file, made by scripts/single_header.cmake: do not edit. It needs Eigen, and must not
// meet the header tree in one program.
//
${licence}${text}")
