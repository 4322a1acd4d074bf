# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D DOXYGEN=PROGRAM -D EXAMPLES=FOLDER -D SITE=FOLDER -P build_site.cmake, where the Doxyfile
# is: writes the site and fails on any warning. Doxygen's own WARN_AS_ERROR cannot tell a function
# without words from a type or a field without: `using Scalar` and `static constexpr int order` are
# those of docs/concepts.md everywhere, and a field may be named so that nothing is left to say.

cmake_minimum_required(VERSION 3.21)

# Every program becomes a page, under the comment that it begins with.
file(GLOB programs ${EXAMPLES}/*.cpp)
set(pages "")
foreach(program IN LISTS programs)
    cmake_path(GET program FILENAME name)
    file(READ "${program}" text)
    string(REGEX MATCH "\n\n(// [^\n]*\n)+" comment "${text}")
    string(REPLACE "\n// " "\n" comment "${comment}")
    string(APPEND pages "/*! @example ${name}\n${comment}*/\n")
endforeach()
file(WRITE examples.dox "${pages}")

file(REMOVE_RECURSE "${SITE}")
execute_process(COMMAND ${DOXYGEN} Doxyfile COMMAND_ERROR_IS_FATAL ANY)
file(READ warnings.txt warnings)
string(REGEX REPLACE "[^\n]*: Member [^\n]* \\((typedef|variable)\\) of [^\n]* is not documented\\.\n" ""
    warnings "${warnings}")
if(NOT warnings STREQUAL "")
    message("${warnings}")
    message(FATAL_ERROR "The documentation has warnings")
endif()
