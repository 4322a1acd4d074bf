# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -P nested.cmake PRESET TARGET PROGRAM [ARGUMENT OF CMAKE...]: builds TARGET in a tree of its own and runs
# PROGRAM of that tree, or its tests if that is `ctest`.
set(more "")
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(i RANGE 6 ${last})
    list(APPEND more ${CMAKE_ARGV${i}})
endforeach()
set(tree ${CMAKE_CURRENT_LIST_DIR}/../../build/deep-${CMAKE_ARGV3})
function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(${CMAKE_COMMAND} --preset ${CMAKE_ARGV3} -B ${tree} ${more})
run(${CMAKE_COMMAND} --build ${tree} --target ${CMAKE_ARGV4})
if(CMAKE_ARGV5 STREQUAL "ctest")
    run(${CMAKE_CTEST_COMMAND} --test-dir ${tree} --output-on-failure)
else()
    run(${tree}/${CMAKE_ARGV5})
endif()
