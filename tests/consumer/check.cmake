# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Builds and runs the consumer in WORK: WAY installed (install, find_package) or subdirectory.
set(consumer ${CMAKE_CURRENT_LIST_DIR})
file(REMOVE_RECURSE ${WORK})

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(config "")
if(CONFIG)
    set(config --config ${CONFIG})
endif()

set(configure ${CMAKE_COMMAND} -S ${consumer} -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
    -D CMAKE_C_COMPILER=${C} -D Eigen3_DIR=${EIGEN})
if(WAY STREQUAL "installed")
    # Moved after the install: a package that remembers where it was built or put would not be found.
    run(${CMAKE_COMMAND} --install ${BUILD} ${config} --prefix ${WORK}/first)
    file(RENAME ${WORK}/first ${WORK}/prefix)
    list(APPEND configure -D CMAKE_PREFIX_PATH=${WORK}/prefix)
else()
    list(APPEND configure -D CONSUMER_SUBDIRECTORY=${SOURCE})
endif()

run(${configure} -B ${WORK}/build -D CONSUMER_SUITESPARSE=${SUITESPARSE})
run(${CMAKE_COMMAND} --build ${WORK}/build ${config})
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/build -C "${CONFIG}" --verbose)

if(WAY STREQUAL "installed")
    execute_process(
        COMMAND ${configure} -B ${WORK}/without -D CONSUMER_SUITESPARSE=ON
            -D CMAKE_DISABLE_FIND_PACKAGE_CHOLMOD=ON -D CHOLMOD_LIBRARY=OFF
        RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE output)
    if(result EQUAL 0 OR NOT output MATCHES "missing:[ \n]+CHOLMOD")
        message(FATAL_ERROR "a missing CHOLMOD was not refused by name:\n${output}")
    endif()
endif()
