# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# conan create with the system's Eigen, in a cache of its own.
cmake_minimum_required(VERSION 3.21)
file(REMOVE_RECURSE ${WORK})
set(ENV{CONAN_HOME} ${WORK}/home)
execute_process(COMMAND ${CONAN} profile detect COMMAND_ERROR_IS_FATAL ANY)
execute_process(
    COMMAND ${CONAN} create ${SOURCE} -s compiler.cppstd=17 -o "taut/*:system_eigen=True"
        -c tools.cmake.cmake_layout:test_folder=${WORK}/test
    COMMAND_ERROR_IS_FATAL ANY)
