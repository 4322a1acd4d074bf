# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# The code in the README is from examples: all of 01_first_step.cpp behind its first comment, and parts of two
# others. Each block of output in examples/README.md is what a program prints about the 64 × 64 cloth, its numbers
# within the range that check/same_output.cpp and check/ranges.txt state.
file(MAKE_DIRECTORY ${folder})
file(READ ${CMAKE_CURRENT_LIST_DIR}/../README.md readme)
string(REPLACE ";" "<semicolon>" code "${readme}")  # or it would part a list
string(REGEX MATCHALL "```cpp\n[^`]*```" blocks "${code}")
list(LENGTH blocks count)
if(NOT count EQUAL 3)
    message(FATAL_ERROR "README.md has ${count} blocks of C++; this script compares three")
endif()
foreach(name IN ITEMS 01_first_step own_arrays 07_paper)
    file(READ ${CMAKE_CURRENT_LIST_DIR}/${name}.cpp example)
    string(REPLACE ";" "<semicolon>" example "${example}")
    list(POP_FRONT blocks block)
    string(REGEX REPLACE "^```cpp\n(.*)```$" "\\1" block "${block}")
    if(name STREQUAL "01_first_step")
        string(FIND "${example}" "// A cloth" start)
        string(SUBSTRING "${example}" ${start} -1 example)
        if(NOT block STREQUAL example)
            message(FATAL_ERROR "README.md does not show examples/${name}.cpp as it is")
        endif()
    endif()
    string(REGEX REPLACE "\n +" "\n" example "${example}")  # README does not indent a part
    string(REGEX REPLACE "\n +" "\n" block "${block}")
    string(FIND "${example}" "${block}" found)
    if(found EQUAL -1)
        message(FATAL_ERROR "README.md shows what is not in examples/${name}.cpp:\n${block}")
    endif()
endforeach()

string(REGEX MATCH "`([^`]+ J before, [^`]+ J after)`" found "${readme}")
file(WRITE ${folder}/quoted "${CMAKE_MATCH_1}\n")
execute_process(COMMAND ${first_step} OUTPUT_FILE ${folder}/printed COMMAND_ERROR_IS_FATAL ANY)
execute_process(
    COMMAND ${same_output} ${CMAKE_CURRENT_LIST_DIR}/check/ranges.txt readme ${folder}/quoted ${folder}/printed
        together
    COMMAND_ERROR_IS_FATAL ANY)

file(READ ${CMAKE_CURRENT_LIST_DIR}/README.md readme)
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
