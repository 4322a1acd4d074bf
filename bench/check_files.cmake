# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D programs=FOLDER -D folder=... -P check_files.cmake
# What the benchmarks say of a mesh that they cannot read, before they measure. Writes into folder only.

cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
include(${CMAKE_CURRENT_LIST_DIR}/../examples/check/expect.cmake)

file(WRITE ${folder}/empty.obj "")
file(WRITE ${folder}/broken.obj "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
foreach(name IN ITEMS step_table stable_step_table dispatch_table implicit_table peers_table resolution_table work_precision)
    find_program(${name} ${name} PATHS ${programs} ${programs}/tradeoff REQUIRED NO_DEFAULT_PATH NO_CACHE)
    set(before "")
    if(name STREQUAL "resolution_table")
        set(before "0.5 ")  # how long
    endif()
    expect(${name} "${before}missing.obj" 1 "^${name}: missing.obj: cannot be opened\n$")
    expect(${name} "${before}empty.obj" 1 "^${name}: empty.obj: has 0 vertices[^\n]*\n$")
    expect(${name} "${before}broken.obj" 1 "^${name}: broken.obj:4: a corner is vertex 9; there are 3\n$")
endforeach()
