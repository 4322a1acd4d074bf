# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Compiles SOURCE by the command after `--`, which writes no file.
include(${CMAKE_CURRENT_LIST_DIR}/../command.cmake)

file(STRINGS ${SOURCE} sentences REGEX "^// EXPECT: ")
if(NOT sentences)
    message(FATAL_ERROR "${SOURCE} has no line `// EXPECT: sentence` or `// EXPECT: success`")
endif()
list(TRANSFORM sentences REPLACE "^// EXPECT: " "")
function(number name word)
    file(STRINGS ${SOURCE} line REGEX "^// ${word}: " LIMIT_COUNT 1)
    string(REPLACE "// ${word}: " "" line "${line}")
    set(${name} "${line}" PARENT_SCOPE)
endfunction()
number(times TIMES)     # so often must a sentence be said; else once
number(allowed ERRORS)  # the compiler may say no more errors than that

execute_process(COMMAND ${command} ${SOURCE}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)

if(sentences STREQUAL "success")
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "must compile, but did not:\n${output}")
    endif()
    return()
endif()
if(result EQUAL 0)
    message(FATAL_ERROR "compiled, but must fail with: ${sentences}")
endif()
string(REPLACE ";" "," output "${output}")
foreach(sentence IN LISTS sentences)
    string(REPLACE "${sentence}" ";" parts "${output}")
    list(LENGTH parts parts)
    math(EXPR said "${parts} - 1")
    if(said LESS 1 OR (times AND said LESS times))
        message(FATAL_ERROR "${said} times, not often enough: ${sentence}\n${output}")
    endif()
endforeach()
string(REGEX MATCHALL " error:| error C[0-9]" errors "${output}")
list(LENGTH errors count)
if(allowed AND count GREATER allowed)
    message(FATAL_ERROR "${count} errors, must be ${allowed} at most:\n${output}")
endif()
