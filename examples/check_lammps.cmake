# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D programs=... -D page=... -D same_output=... -D folder=... -P check_lammps.cmake
# Runs the page's commands of its worked case in order, and compares what they print with the lines
# that the page quotes ("    > …").

file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder}/quotes)
file(STRINGS ${page} lines REGEX "^    (build/demo/examples/|[(]cd )")
list(LENGTH lines count)
if(count LESS 3)
    message(FATAL_ERROR "${page} has ${count} commands; there should be three and more")
endif()
set(output "")
foreach(line IN LISTS lines)
    string(STRIP "${line}" command)
    string(REPLACE "build/demo/examples/" "${programs}/" command "${command}")
    execute_process(COMMAND sh -c "${command}" WORKING_DIRECTORY ${folder}
        OUTPUT_VARIABLE printed ERROR_VARIABLE error RESULT_VARIABLE result)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${line}\nexits with ${result}:\n${printed}${error}")
    endif()
    string(APPEND output "${printed}")
endforeach()
file(WRITE ${folder}/quotes/lammps.printed "${output}")
execute_process(
    COMMAND ${same_output} ${CMAKE_CURRENT_LIST_DIR}/check/ranges.txt lammps ${page}
        ${folder}/quotes/lammps.printed
    COMMAND_ERROR_IS_FATAL ANY)
