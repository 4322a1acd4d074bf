# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Runs a program; its exit code and what stdout and stderr say must be as expected.
function(expect program arguments code regex)
    separate_arguments(list UNIX_COMMAND "${arguments}")
    execute_process(COMMAND ${${program}} ${list} WORKING_DIRECTORY ${folder}
        RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
    if(NOT result STREQUAL code OR NOT "${error}${output}" MATCHES "${regex}")
        message(SEND_ERROR "${program} ${arguments}\n  exit code ${result}, expected ${code};"
            " expected text: ${regex}\n${error}${output}")
    endif()
endfunction()
