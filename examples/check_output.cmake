# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# The program (or several, with commas between) succeeds, and prints every line that the page quotes
# ("    > …"), its numbers within the range that check/same_output.cpp and check/ranges.txt state.
cmake_path(GET page STEM name)
string(REPLACE "," ";" programs "${program}")
set(output "")
foreach(program IN LISTS programs)
    execute_process(COMMAND ${program} OUTPUT_VARIABLE printed RESULT_VARIABLE result)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${program} exits with ${result}:\n${printed}")
    endif()
    string(APPEND output "${printed}")
endforeach()
file(WRITE ${folder}/${name}.printed "${output}")
execute_process(
    COMMAND ${same_output} ${CMAKE_CURRENT_LIST_DIR}/check/ranges.txt ${name} ${page}
        ${folder}/${name}.printed
    COMMAND_ERROR_IS_FATAL ANY)
