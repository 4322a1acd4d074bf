# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# The program (or several, with commas between) succeeds, and prints every line that the page quotes
# ("    > …"), its numbers apart.
include(${CMAKE_CURRENT_LIST_DIR}/without_numbers.cmake)
string(REPLACE "," ";" programs "${program}")
set(output "")
foreach(program IN LISTS programs)
    execute_process(COMMAND ${program} OUTPUT_VARIABLE printed RESULT_VARIABLE result)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${program} exits with ${result}:\n${printed}")
    endif()
    string(APPEND output "${printed}")
endforeach()

without_numbers("${output}" printed)
file(STRINGS ${page} quoted REGEX "^    > ")
if(NOT quoted)
    message(FATAL_ERROR "${page} quotes no output")
endif()
foreach(line IN LISTS quoted)
    string(SUBSTRING "${line}" 6 -1 line)
    without_numbers("${line}" wanted)
    string(FIND "${printed}" "${wanted}\n" found)
    if(found EQUAL -1)
        message(SEND_ERROR "${page} quotes \"${line}\"; ${programs} print\n${output}")
    endif()
endforeach()
