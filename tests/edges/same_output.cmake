# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D PROGRAM=... -P same_output.cmake
# Two runs must print the same line, whatever the memory's layout and the number of threads; the steppers, which
# are told the number, are compared by one of them.
set(lines "")
foreach(threads IN ITEMS 1 3)
    set(ENV{OMP_NUM_THREADS} ${threads})
    set(what "")
    if(threads EQUAL 1)
        set(what play)
    endif()
    execute_process(COMMAND ${PROGRAM} ${what} OUTPUT_VARIABLE line COMMAND_ERROR_IS_FATAL ANY)
    list(APPEND lines "${line}")
endforeach()
list(REMOVE_DUPLICATES lines)
list(LENGTH lines count)
if(NOT count EQUAL 1 OR NOT lines MATCHES "^[0-9a-f]+ [0-9a-f]+\n$")
    message(FATAL_ERROR "runs differ, or print nothing:\n${lines}")
endif()
