# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

file(STRINGS ${SOURCE} expected REGEX "^// EXPECT: " LIMIT_COUNT 1)
if(NOT expected)
    message(FATAL_ERROR "${SOURCE} has no line `// EXPECT: sentence` or `// EXPECT: success`")
endif()
string(REPLACE "// EXPECT: " "" expected "${expected}")
# `// ERRORS: n`: the compiler may say no more than that.
file(STRINGS ${SOURCE} allowed REGEX "^// ERRORS: " LIMIT_COUNT 1)
string(REPLACE "// ERRORS: " "" allowed "${allowed}")

set(config "")
if(CONFIG)
    set(config --config ${CONFIG})
endif()
execute_process(
    COMMAND ${CMAKE_COMMAND} --build ${BUILD} --target ${TARGET} ${config}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)

if(expected STREQUAL "success")
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "must compile, but did not:\n${output}")
    endif()
elseif(result EQUAL 0)
    message(FATAL_ERROR "compiled, but must fail with: ${expected}")
else()
    string(FIND "${output}" "${expected}" position)
    if(position EQUAL -1)
        message(FATAL_ERROR "failed without the sentence: ${expected}\n${output}")
    endif()
    string(REGEX MATCHALL " error:| error C[0-9]" errors "${output}")
    list(LENGTH errors count)
    if(allowed AND count GREATER allowed)
        message(FATAL_ERROR "${count} errors, must be ${allowed} at most:\n${output}")
    endif()
endif()
