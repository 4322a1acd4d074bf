# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D programs=FOLDER -D folder=... -P check_files.cmake
# What the benchmarks say of a mesh that they cannot read and of arguments that they do not know, before they
# measure. Writes into folder only.

cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
include(${CMAKE_CURRENT_LIST_DIR}/../examples/check/expect.cmake)

file(WRITE ${folder}/empty.obj "")
file(WRITE ${folder}/broken.obj "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
function(find name)
    find_program(${name} ${name} PATHS ${programs} ${programs}/tradeoff REQUIRED NO_DEFAULT_PATH NO_CACHE)
    set(${name} ${${name}} PARENT_SCOPE)
endfunction()
foreach(name IN ITEMS step_table stable_step_table dispatch_table implicit_table peers_table resolution_table work_precision)
    find(${name})
    set(before "")
    if(name STREQUAL "resolution_table")
        set(before "0.5 ")  # how long
    endif()
    expect(${name} "${before}missing.obj" 1 "^${name}: missing.obj: cannot be opened\n$")
    expect(${name} "${before}empty.obj" 1 "^${name}: empty.obj: has 0 vertices[^\n]*\n$")
    expect(${name} "${before}broken.obj" 1 "^${name}: broken.obj:4: a corner is vertex 9; there are 3\n$")
endforeach()
foreach(name IN ITEMS frame_table same_bits_table)
    find(${name})
    expect(${name} "64" 2 "^${name} takes no arguments\n$")
endforeach()
find(guard_costs)
foreach(bad IN ITEMS "1" "cloth" "64 64")
    expect(guard_costs "${bad}" 2 "^guard_costs \\[SIZE\\], particles along an edge, at least 2\n$")
endforeach()
find(cape_table)
foreach(bad IN ITEMS "0" "cloth" "60s" "60 name")
    expect(cape_table "${bad}" 2 "^cape_table \\[SECONDS \\[NAME COMMAND\\]\\.\\.\\.\\], 1 to 3600 s\n$")
endforeach()
