# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# From another folder, with its own paths, the script must write the same bytes; they hold the
# licence, and nothing of this machine.
cmake_minimum_required(VERSION 3.21)
cmake_path(GET SCRIPT PARENT_PATH scripts)
cmake_path(GET scripts PARENT_PATH root)
file(REMOVE_RECURSE ${WORK}/elsewhere)
file(COPY ${root}/include ${root}/LICENSE ${scripts} DESTINATION ${WORK}/elsewhere)
execute_process(
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=second.hpp -D ALSO=guard/guard.hpp -P scripts/single_header.cmake
    WORKING_DIRECTORY ${WORK}/elsewhere COMMAND_ERROR_IS_FATAL ANY)
execute_process(
    COMMAND ${CMAKE_COMMAND} -E compare_files ${FIRST} ${WORK}/elsewhere/second.hpp
    COMMAND_ERROR_IS_FATAL ANY)

# Modules come on request, and those that do not exist are named.
execute_process(
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=more.hpp "-D ALSO=suitesparse/suitesparse.hpp;bdf2/bdf2.hpp"
        -P scripts/single_header.cmake
    WORKING_DIRECTORY ${WORK}/elsewhere COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${WORK}/elsewhere/more.hpp classes REGEX "^class (Cholmod|Umfpack|Bdf2|SymplecticEuler) ")
list(LENGTH classes count)
if(NOT count EQUAL 4)
    message(FATAL_ERROR "with ALSO the single header holds: ${classes}")
endif()
execute_process(
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=more.hpp -D ALSO=bdf2/none.hpp
        -P scripts/single_header.cmake
    WORKING_DIRECTORY ${WORK}/elsewhere RESULT_VARIABLE result ERROR_VARIABLE error)
if(result EQUAL 0 OR NOT error MATCHES "no include/taut/bdf2/none.hpp")
    message(FATAL_ERROR "a header that does not exist was not refused by name:\n${error}")
endif()

file(READ ${FIRST} text)
foreach(part IN ITEMS "Permission is hereby granted" "SPDX-License-Identifier: MIT")
    string(FIND "${text}" "${part}" at)
    if(at EQUAL -1)
        message(FATAL_ERROR "the single header lacks: ${part}")
    endif()
endforeach()
foreach(part IN ITEMS "${root}" "#include \"")
    string(FIND "${text}" "${part}" at)
    if(NOT at EQUAL -1)
        message(FATAL_ERROR "the single header has: ${part}")
    endif()
endforeach()
