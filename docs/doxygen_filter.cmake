# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -P doxygen_filter.cmake FILE: prints a header or a page as Doxygen 1.9.4 has to read it. No
# line moves, so that its warnings name the right one.

cmake_minimum_required(VERSION 3.21)

# Doxygen takes an initial's dot for the end of the first sentence, and finds the declaration of a
# member template by the words of its return type.
function(filter_header text)
    string(REGEX REPLACE "([ (-][A-Z])\\. " "\\1.&nbsp;" text "${text}")
    string(REGEX REPLACE "\nauto ([^;{}]+)\n    -> ([^;{}]+) {" "\n\\2 \\1\n{" text "${text}")
    string(REGEX REPLACE "\nauto ([^;{}]+) -> ([^;{}]+) {" "\n\\2 \\1 {" text "${text}")
    string(REGEX MATCHALL "\n[A-Za-z]+<[A-Za-z]+> [A-Za-z]+<[A-Za-z]+>::" starts "${text}")
    foreach(start IN LISTS starts)
        if(start MATCHES "^\n([A-Za-z]+)<[A-Za-z]+> ([A-Za-z]+)(<.+)$" AND
                CMAKE_MATCH_1 STREQUAL CMAKE_MATCH_2)
            string(REPLACE "${start}" "\n${CMAKE_MATCH_1} ${CMAKE_MATCH_1}${CMAKE_MATCH_3}" text
                "${text}")
        endif()
    endforeach()
    set(text "${text}" PARENT_SCOPE)
endfunction()

# The identifier of a heading of a page. Doxygen has one set of them for all pages.
function(identifier result page slug)
    page_name(name "${page}")
    set(${result} "${name}-${slug}" PARENT_SCOPE)
endfunction()

# The words of a heading as the end of a link to it.
function(heading_slug result heading)
    string(REGEX REPLACE "^\n?#+ " "" slug "${heading}")
    string(TOLOWER "${slug}" slug)
    string(REGEX REPLACE "[^a-z0-9 _-]" "" slug "${slug}")
    string(REPLACE " " "-" slug "${slug}")
    set(${result} "${slug}" PARENT_SCOPE)
endfunction()

# A label as [T19] that is no link yet becomes one, in parentheses, to the section of docs/theory/ that has its
# formula, but for the one in the formula itself.
# Brackets are <open> and <close> here.
macro(link_labels)
    string(REGEX REPLACE "<open>(T[0-9]+)<close>\\(" "<linked>\\1<close>(" text "${text}")
    string(REPLACE "textbf{<open>" "textbf{<linked>" text "${text}")
    file(GLOB theory_pages "${CMAKE_CURRENT_LIST_DIR}/theory/*.md")
    foreach(theory_page IN LISTS theory_pages)
        file(STRINGS "${theory_page}" lines REGEX "^## |textbf{[[]T[0-9]+\\]}$")
        foreach(line IN LISTS lines)
            if(line MATCHES "^## ")
                heading_slug(section "${line}")
                identifier(section "${theory_page}" "${section}")
            elseif(line MATCHES "[[](T[0-9]+)\\]}$")
                string(REPLACE "<open>${CMAKE_MATCH_1}<close>"
                    "(<linked>${CMAKE_MATCH_1}<close>(@ref ${section}))" text "${text}")
            endif()
        endforeach()
    endforeach()
    string(REPLACE "<linked>" "<open>" text "${text}")
endmacro()

# The name of a page, and so of its file on the site.
function(page_name result page)
    cmake_path(NORMAL_PATH page)
    cmake_path(GET page STEM stem)
    cmake_path(GET page PARENT_PATH parent)
    cmake_path(GET parent FILENAME parent)
    string(TOLOWER "${stem}" stem)
    if(parent STREQUAL "docs" OR stem MATCHES "^(contributing|changelog)$")
        set(${result} "${stem}" PARENT_SCOPE)
    elseif(NOT stem STREQUAL "readme")
        set(${result} "${parent}_${stem}" PARENT_SCOPE)
    elseif(EXISTS "${page}" AND parent MATCHES "^(systems|bench|examples)$")
        set(${result} "${parent}" PARENT_SCOPE)
    else()
        set(${result} index PARENT_SCOPE)
    endif()
endfunction()

# Pages are written for their place in the repository, where links to headings, programs and folders
# work. On the site a page is called by its file, a heading by its words, a program has its page among the
# examples, and other files and folders have none; what does not exist becomes a reference that Doxygen
# refuses. A block of ```math becomes a formula.
function(filter_page text)
    # CMake's lists would split at these.
    string(REPLACE ";" "<semicolon>" text "${text}")
    string(REPLACE "[" "<open>" text "${text}")
    string(REPLACE "]" "<close>" text "${text}")

    page_name(name "${file}")
    if(NOT name STREQUAL "index")
        string(REGEX REPLACE "^(# [^\n]+)\n" "\\1 {#${name}}\n" text "${text}")
    endif()

    # Formulas stand apart from links and spans of code: their backslashes and brackets are TeX's.
    string(REGEX REPLACE "\n```math\n([^`]*)\n```\n" "\n\\\\f[\n\\1\n\\\\f]\n" text "${text}")

    set(known "")
    string(REGEX MATCHALL "\n##+ [^\n]+" headings "${text}")
    foreach(heading IN LISTS headings)
        heading_slug(slug "${heading}")
        if(NOT slug IN_LIST known)
            list(APPEND known "${slug}")
            identifier(id "${file}" "${slug}")
            string(REPLACE "${heading}\n" "${heading} {#${id}}\n" text "${text}")
        endif()
    endforeach()

    # To Doxygen an apostrophe ends a code span of single backticks.
    string(REGEX MATCHALL "```[^`]*```|`[^`]+`" spans "${text}")
    list(FILTER spans INCLUDE REGEX "^`[^`]+'")
    foreach(span IN LISTS spans)
        string(REPLACE "${span}" "`${span}`" text "${text}")
    endforeach()

    # The README of a folder of docs/ stands above the other pages there, and docs/theory.md above docs/theory/.
    set(contents "")
    set(below "")
    if(file MATCHES "/docs/([a-z_]+)/README\\.md$" AND NOT CMAKE_MATCH_1 STREQUAL "docs")
        set(contents "${CMAKE_MATCH_1}")
    elseif(name STREQUAL "theory")
        set(contents theory)
        set(below "theory/")
    endif()
    # Without a space: "](auto& x)" is C++.
    string(REGEX MATCHALL "<close>\\([^) \n]+\\)" links "${text}")
    list(REMOVE_DUPLICATES links)
    foreach(link IN LISTS links)
        string(REGEX REPLACE "^<close>\\(|\\)$" "" target "${link}")
        if(target MATCHES "^([^:#]*)#(.+)$")
            set(page "${file}")
            if(CMAKE_MATCH_1)
                set(page "${folder}/${CMAKE_MATCH_1}")
            endif()
            identifier(id "${page}" "${CMAKE_MATCH_2}")
            string(REPLACE "${link}" "<close>(@ref ${id})" text "${text}")
        elseif(contents AND target MATCHES "^${below}([a-z_]+)\\.md$")
            string(REGEX REPLACE "<open>([^<\n]+)<close>\\(${target}\\)"
                "@subpage ${contents}_${CMAKE_MATCH_1} \"\\1\"" text "${text}")
        elseif(target MATCHES "\\.md$" AND EXISTS "${folder}/${target}")
            page_name(id "${folder}/${target}")
            string(REPLACE "${link}" "<close>(@ref ${id})" text "${text}")
        elseif(target MATCHES "([^/:]+\\.cpp)$")
            string(REPLACE "${link}" "<close>(@ref ${CMAKE_MATCH_1})" text "${text}")
        elseif(target MATCHES ":" OR
                (target MATCHES "\\.(png|svg)$" AND EXISTS "${folder}/${target}"))
            continue()
        elseif(EXISTS "${folder}/${target}")
            string(REPLACE "<close>(${target})" "<nowhere>" text "${text}")
            string(REGEX REPLACE "<open>([^<\n]+)<nowhere>" "\\1" text "${text}")
        else()
            string(REPLACE "${link}" "<close>(@ref ${target})" text "${text}")
        endif()
    endforeach()

    link_labels()
    string(REPLACE "<open>" "[" text "${text}")
    string(REPLACE "<close>" "]" text "${text}")
    string(REPLACE "<semicolon>" ";" text "${text}")
    set(text "${text}" PARENT_SCOPE)
endfunction()

set(file "${CMAKE_ARGV3}")
cmake_path(GET file PARENT_PATH folder)
file(READ "${file}" text)
if(file MATCHES "\\.md$")
    filter_page("${text}")
else()
    filter_header("${text}")
endif()

# CMake itself cannot write to standard output without a decoration.
string(RANDOM name)
set(filtered "${CMAKE_CURRENT_BINARY_DIR}/filtered_${name}")
file(WRITE "${filtered}" "${text}")
execute_process(COMMAND ${CMAKE_COMMAND} -E cat "${filtered}")
file(REMOVE "${filtered}")
