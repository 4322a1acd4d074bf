# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D DOXYGEN=PROGRAM -D EXAMPLES=FOLDER -D SITE=FOLDER -D MATHJAX=FOLDER -P build_site.cmake, where
# the Doxyfile is: writes the site and fails on any warning. Doxygen's own WARN_AS_ERROR cannot tell a function
# without words from a type or a field without: `using Scalar` and `static constexpr int order` are
# those of docs/concepts.md everywhere, and a field may be named so that nothing is left to say.

cmake_minimum_required(VERSION 3.21)

# Every program becomes a page, under the comment that it begins with.
file(GLOB programs ${EXAMPLES}/*.cpp ${EXAMPLES}/scenes/*.cpp)
set(pages "")
foreach(program IN LISTS programs)
    cmake_path(GET program FILENAME name)
    file(READ "${program}" text)
    string(REGEX MATCH "\n\n(// [^\n]*\n)+" comment "${text}")
    string(REPLACE "\n// " "\n" comment "${comment}")
    string(APPEND pages "/*! @example ${name}\n${comment}*/\n")
endforeach()
file(WRITE examples.dox "${pages}")

# Doxygen's layout, its tabs under names that say what is behind them.
execute_process(COMMAND ${DOXYGEN} -l layout.xml COMMAND_ERROR_IS_FATAL ANY)
file(READ layout.xml layout)
foreach(tab IN ITEMS "mainpage:Taut" "pages:Pages" "files:Headers" "examples:Programs")
    string(REGEX MATCH "^([a-z]+):(.+)$" tab "${tab}")
    string(REGEX REPLACE "(<tab type=\"${CMAKE_MATCH_1}\" visible=\"yes\" title=\")\"" "\\1${CMAKE_MATCH_2}\""
        layout "${layout}")
endforeach()
file(WRITE layout.xml "${layout}")

file(REMOVE_RECURSE "${SITE}")
execute_process(COMMAND ${DOXYGEN} Doxyfile COMMAND_ERROR_IS_FATAL ANY)
file(READ warnings.txt warnings)
string(REGEX REPLACE "[^\n]*: Member [^\n]* \\((typedef|variable)\\) of [^\n]* is not documented\\.\n" ""
    warnings "${warnings}")
if(NOT warnings STREQUAL "")
    message("${warnings}")
    message(FATAL_ERROR "The documentation has warnings")
endif()

# The part of MathJax that writes TeX as SVG.
foreach(part IN ITEMS MathJax.js extensions jax/element jax/input/TeX jax/output/SVG)
    cmake_path(GET part PARENT_PATH folder)
    file(COPY "${MATHJAX}/${part}" DESTINATION "${SITE}/mathjax/${folder}"
        REGEX "/fonts/(Asana|Gyre|Latin|Neo|STIX)" EXCLUDE REGEX "/extensions/(a11y|HTML-CSS|MathML)" EXCLUDE)
endforeach()
