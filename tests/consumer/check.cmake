# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Builds and runs the consumer in WORK. WAY installed: install, find_package, pkg-config, and what a
# package refuses; subdirectory: add_subdirectory, FetchContent.
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
    -D CMAKE_C_COMPILER=${C} -D Eigen3_DIR=${EIGEN} -D CMAKE_PREFIX_PATH=${WORK}/prefix
    -D CONSUMER_SOURCE=${SOURCE})

function(build way standard program)
    run(${configure} -B ${WORK}/${way} -D CONSUMER_WAY=${way} -D CONSUMER_STANDARD=${standard}
        -D CONSUMER_PROGRAM=${program} ${ARGN})
    run(${CMAKE_COMMAND} --build ${WORK}/${way} ${config})
    run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/${way} -C "${CONFIG}" --verbose)
endfunction()

if(WAY STREQUAL "subdirectory")
    # That the targets arrive; what they do, the others see.
    build(subdirectory 20 version.cpp)
    build(fetched 17 version.cpp -D CONSUMER_SUITESPARSE=${SUITESPARSE} -D CONSUMER_MODAL=${MODAL})
    return()
endif()

# Moved after the install: a package that remembers where it was built or put would not be found.
run(${CMAKE_COMMAND} --install ${BUILD} ${config} --prefix ${WORK}/first)
file(RENAME ${WORK}/first ${WORK}/prefix)
build(installed 17 main.cpp -D CONSUMER_SUITESPARSE=${SUITESPARSE} -D CONSUMER_MODAL=${MODAL}
    -D CONSUMER_COMPILED=${COMPILED})

run(${CMAKE_COMMAND} -S ${consumer}/refusals -B ${WORK}/refusals -G ${GENERATOR}
    -D CMAKE_PREFIX_PATH=${WORK}/prefix -D Eigen3_DIR=${EIGEN})
execute_process(
    COMMAND ${configure} -B ${WORK}/without -D CONSUMER_WAY=installed -D CONSUMER_SUITESPARSE=ON
        -D CONSUMER_STANDARD=17 -D CONSUMER_PROGRAM=version.cpp -D CMAKE_DISABLE_FIND_PACKAGE_CHOLMOD=ON -D CHOLMOD_LIBRARY=OFF
    RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "missing:[ \n]+CHOLMOD")
    message(FATAL_ERROR "a missing CHOLMOD was not refused by name:\n${output}")
endif()

if(PKG_CONFIG)
    set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/share/pkgconfig)
    execute_process(COMMAND ${PKG_CONFIG} --cflags taut
        OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    run(${CXX} -std=c++17 ${flags} ${consumer}/version.cpp -o ${WORK}/version)
    execute_process(COMMAND ${WORK}/version
        OUTPUT_VARIABLE header OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${PKG_CONFIG} --modversion taut
        OUTPUT_VARIABLE package OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    if(NOT package STREQUAL header)
        message(FATAL_ERROR "pkg-config says ${package}, the header ${header}")
    endif()
endif()
