# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D stability_report=... -D folder=... -P check_resolution.cmake
# What stability_report --resolve answers. Writes into folder only.

cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
include(${CMAKE_CURRENT_LIST_DIR}/check/expect.cmake)

set(real "%%MatrixMarket matrix coordinate real")
file(WRITE ${folder}/M.mtx "${real} general\n2 2 2\n1 1 1\n2 2 1\n")
file(WRITE ${folder}/K.mtx "${real} symmetric\n2 2 3\n1 1 2\n2 1 -1\n2 2 2\n")

set(cloth "--scene hanging_cloth --size 4")
set(soft "--scene hanging_cloth --size 40 --stretch 40 --bend 0.4")
expect(stability_report "${soft} --resolve 10% --duration 0.3 --json fewer.json" 0
    "particles .*certified step.*are estimated to stay within .*times cheaper than all 1600.*errors are estimates")
file(READ ${folder}/fewer.json fewer)
string(JSON outcome GET "${fewer}" resolution outcome)
string(JSON estimated GET "${fewer}" resolution estimated_error)
string(JSON levels LENGTH "${fewer}" resolution levels)
if(NOT outcome STREQUAL "coarse" OR NOT estimated LESS_EQUAL 0.05 OR levels LESS 3)
    message(SEND_ERROR "fewer.json: ${outcome}, ${estimated}, ${levels} levels")
endif()
expect(stability_report "${soft} --resolve 0.01% --duration 0.3" 0 "own 1600 particles are needed")
expect(stability_report "${cloth} --resolve 1%" 0 "own 16 particles are needed")
expect(stability_report "${cloth} --resolve 3% --free --gravity 0" 0 "Nothing moves for 2 s: any number")
expect(stability_report "${cloth} --resolve 0" 105 "--resolve.*> 0")
expect(stability_report "${cloth} --resolve -3%" 105 "--resolve.*> 0")
expect(stability_report "${cloth} --resolve 3% --duration 0" 105 "--duration.*> 0")
expect(stability_report "${cloth} --duration 1" 107 "--duration requires --resolve")
expect(stability_report "--stiffness-matrix K.mtx --mass-matrix M.mtx --resolve 3%" 108 "--resolve")
