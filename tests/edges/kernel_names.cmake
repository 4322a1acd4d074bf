# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D NM=nm -D OBJECTS="a.o;b.o;..." -P kernel_names.cmake
# What a unit of Taut::Compiled for wide registers defines for the linker has that unit's own names: of a function
# that two units define the linker keeps one, and an old processor might get the other's.
cmake_minimum_required(VERSION 3.21)
set(faults "")
set(units 0)
set(names 0)
foreach(object IN LISTS OBJECTS)
    if(NOT object MATCHES "/(avx2|avx512)_(float|double)[.][^/]*$")
        continue()
    endif()
    set(set ${CMAKE_MATCH_1})
    math(EXPR units "${units} + 1")
    execute_process(COMMAND ${NM} ${object} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
    # Other small letters: of names that nobody else sees.
    string(REGEX MATCHALL "[0-9a-f]+ [A-Zu-w] [^\n]*" symbols "${output}")
    foreach(symbol IN LISTS symbols)
        math(EXPR names "${names} + 1")
        if(NOT symbol MATCHES "(taut|Eigen)_${set}")
            list(APPEND faults "${object} defines ${symbol}")
        endif()
    endforeach()
endforeach()
if(units LESS 2 OR names LESS 100)
    list(APPEND faults "${units} units define ${names} names: the test looks at the wrong files")
endif()
if(faults)
    list(JOIN faults "\n  " faults)
    message(FATAL_ERROR "kernel_names:\n  ${faults}")
endif()
message(STATUS "${units} units define ${names} names of their own")
