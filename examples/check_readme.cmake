# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# The code in the README is examples/01_first_step.cpp, from its first comment on, and each block of
# output is what a program prints about the 64 × 64 cloth, its numbers within the range that
# check/same_output.cpp and check/ranges.txt state.
file(MAKE_DIRECTORY ${folder})
file(READ ${CMAKE_CURRENT_LIST_DIR}/01_first_step.cpp example)
file(READ ${CMAKE_CURRENT_LIST_DIR}/../README.md readme)
string(FIND "${example}" "// A cloth" start)
string(SUBSTRING "${example}" ${start} -1 example)
string(FIND "${readme}" "```cpp\n${example}```" found)
if(start EQUAL -1 OR found EQUAL -1)
    message(FATAL_ERROR "README.md does not show examples/01_first_step.cpp as it is")
endif()

string(FIND "${readme}" "```text\n" block)
foreach(program IN ITEMS ${stability_report} ${prediction})
    string(SUBSTRING "${readme}" ${block} -1 readme)
    string(SUBSTRING "${readme}" 8 -1 readme)
    string(FIND "${readme}" "```" end)
    string(SUBSTRING "${readme}" 0 ${end} quoted)
    execute_process(COMMAND ${program} --scene hanging_cloth --size 64 OUTPUT_FILE ${folder}/printed
        COMMAND_ERROR_IS_FATAL ANY)
    file(WRITE ${folder}/quoted "${quoted}")
    execute_process(
        COMMAND ${same_output} ${CMAKE_CURRENT_LIST_DIR}/check/ranges.txt readme ${folder}/quoted
            ${folder}/printed together
        COMMAND_ERROR_IS_FATAL ANY)
    string(SUBSTRING "${readme}" ${end} -1 readme)
    string(SUBSTRING "${readme}" 3 -1 readme)
    string(FIND "${readme}" "```text\n" block)
endforeach()
