# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D stability_report=... -D folder=... -P check_bounds.cmake
# What the table prints as certified is at most what is certified, what it prints as refuted at least what is
# refuted, as the JSON says both to the last bit: of scenes of many sizes and stiffnesses.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

set(compared 0)
set(number "[0-9.]+e[-+][0-9]+")
# The text must be on the `side` (LESS_EQUAL, GREATER_EQUAL) of a member of the JSON.
function(compare text side)
    string(JSON value GET "${json}" ${ARGN})
    if(NOT text ${side} value)
        message(SEND_ERROR "--size ${size} --stretch ${stretch}: printed is ${text}, ${ARGN} is ${value}")
    endif()
    math(EXPR compared "${compared} + 1")
    set(compared ${compared} PARENT_SCOPE)
endfunction()

foreach(size RANGE 3 14)
    math(EXPR stretch "1000 + 377 * ${size} * ${size}")
    execute_process(
        COMMAND ${stability_report} --scene hanging_cloth --size ${size} --stretch ${stretch} --alpha 1e-5
            --want-step 1/2000 --json report.json
        WORKING_DIRECTORY ${folder} OUTPUT_VARIABLE table COMMAND_ERROR_IS_FATAL ANY)
    file(READ ${folder}/report.json json)
    set(rest "${table}")
    foreach(key IN ITEMS explicit_euler symplectic_euler any_pose energy_stable)
        string(REGEX MATCH "\n  [a-z]+[- a-z]* Euler +(${number}) s +(${number}) s +[0-9.]+ %[^\n]*(.*)" row "${rest}")
        if(NOT row)
            message(FATAL_ERROR "--size ${size}: no row of ${key} in\n${table}")
        endif()
        set(rest "${CMAKE_MATCH_3}")
        compare(${CMAKE_MATCH_1} LESS_EQUAL ${key} certified)
        compare(${CMAKE_MATCH_2} GREATER_EQUAL ${key} refuted)
    endforeach()
    if(table MATCHES "k_max in \\[([0-9.e+]+), ([0-9.e+]+)\\]")
        compare(${CMAKE_MATCH_1} LESS_EQUAL k_max lower)
        compare(${CMAKE_MATCH_2} GREATER_EQUAL k_max upper)
    endif()
    if(table MATCHES "alpha in \\((${number}), (${number})\\)")
        compare(${CMAKE_MATCH_1} GREATER_EQUAL rayleigh_window lower)
        compare(${CMAKE_MATCH_2} LESS_EQUAL rayleigh_window upper)
    endif()
    if(table MATCHES "all stiffness times ([0-9.e-]+), or all masses times ([0-9.e+]+)")
        compare(${CMAKE_MATCH_1} LESS_EQUAL want_step stiffness_scale)
        compare(${CMAKE_MATCH_2} GREATER_EQUAL want_step mass_scale)
    endif()
endforeach()
if(compared LESS 150)
    message(SEND_ERROR "${compared} numbers alone were compared")
endif()
