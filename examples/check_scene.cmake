# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# A program of scenes/ succeeds, writes an OBJ file, and prints what mechanics says. The same text with
# its measured number a fifth larger must not pass: a check that cannot fail shows nothing.
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
execute_process(COMMAND ${program} WORKING_DIRECTORY ${folder} OUTPUT_FILE ${folder}/printed
    COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${check_scenes} ${scene} ${folder}/printed COMMAND_ERROR_IS_FATAL ANY)
file(GLOB written ${folder}/*.obj)
if(NOT written)
    message(FATAL_ERROR "${scene} writes no OBJ file")
endif()
execute_process(COMMAND ${check_scenes} ${scene} ${folder}/printed 1.2
    RESULT_VARIABLE result OUTPUT_QUIET)
if(NOT result EQUAL 1)
    message(FATAL_ERROR "check_scenes ${scene} exits with ${result} where numbers are a fifth off")
endif()
