# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D stability_report=... -D prediction=... -D drape=... -D engine_loop=... -D folder=...
#     -P check_programs.cmake
# What the programs answer to wrong input, and the keys of the report's JSON. Writes into folder
# only.

cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

# Runs a program; its exit code and what stdout and stderr say must be as expected.
function(expect program arguments code regex)
    separate_arguments(list UNIX_COMMAND "${arguments}")
    execute_process(COMMAND ${${program}} ${list} WORKING_DIRECTORY ${folder}
        RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
    if(NOT result STREQUAL code OR NOT "${error}${output}" MATCHES "${regex}")
        message(SEND_ERROR "${program} ${arguments}\n  exit code ${result}, expected ${code};"
            " expected text: ${regex}\n${error}${output}")
    endif()
endfunction()

set(corners "v 0 0 0\nv 1 0 0\nv 0 1 0\n")
file(WRITE ${folder}/triangle.obj "${corners}f 1 2 3\n")
file(WRITE ${folder}/empty.obj "")
string(ASCII 1 2 200 255 13 10 3 control)
file(WRITE ${folder}/binary.obj "glTF${control}")
file(WRITE ${folder}/range.obj "${corners}f 1 2 9\n")
file(WRITE ${folder}/wrap.obj "${corners}f 4294967297 2 3\n")
file(WRITE ${folder}/short.obj "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n")
file(WRITE ${folder}/nan.obj "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")

set(real "%%MatrixMarket matrix coordinate real")
file(WRITE ${folder}/M.mtx "${real} general\n2 2 2\n1 1 1\n2 2 1\n")
file(WRITE ${folder}/K.mtx "${real} symmetric\n2 2 3\n1 1 2\n2 1 -1\n2 2 2\n")
file(WRITE ${folder}/shape.mtx "${real} general\n3 3 1\n1 1 1\n")
file(WRITE ${folder}/asymmetric.mtx "${real} general\n2 2 3\n1 1 2\n2 1 -1\n2 2 2\n")
file(WRITE ${folder}/above.mtx "${real} symmetric\n2 2 3\n1 1 2\n1 2 -1\n2 2 2\n")
file(WRITE ${folder}/full.mtx "${real} symmetric\n2 2 3\n1 1 2\n2 1 1\n2 2 2\n")
file(WRITE ${folder}/negative.mtx "${real} general\n2 2 2\n1 1 1\n2 2 -1\n")
file(WRITE ${folder}/nan.mtx "${real} general\n2 2 2\n1 1 1\n2 2 nan\n")
file(WRITE ${folder}/word.mtx "${real} general\n2 2 2\n1 1 1\n2 2 1x\n")
file(WRITE ${folder}/truncated.mtx "${real} general\n2 2 2\n1 1 1\n")

set(cloth "--scene hanging_cloth --size 4")
expect(stability_report "" 1 "name a mesh")
expect(stability_report "${cloth} --pin x" 1 "--pin: \"x\"")
expect(stability_report "${cloth} --pin 7-3" 1 "--pin: \"7-3\"")
expect(stability_report "${cloth} --pin 16" 1 "--pin: vertex 16 does not exist")
expect(stability_report "triangle.obj --size 4" 1 "--size")
expect(stability_report "${cloth} --mass -1" 105 "--mass")
expect(stability_report "triangle.obj" 0 "symplectic Euler")
expect(stability_report "triangle.obj --pin 0 --stretch 1000 --bend 100 --mass 0.3" 0 "any pose")
expect(stability_report "${cloth} --blame 5" 0 "particle [0-9]+ .*kinetic energy")
expect(stability_report "${cloth} --want-step 0.02" 0 "all stiffness times .*kg more on")
expect(stability_report "${cloth} --step 0.0001" 0 "stable for alpha")
expect(stability_report "missing.obj" 1 "missing.obj: cannot be opened")
expect(stability_report "empty.obj" 1 "empty.obj: has 0 vertices")
expect(stability_report "binary.obj" 1 "binary.obj: ")
expect(stability_report "range.obj" 1 "range.obj: ")
expect(stability_report "wrap.obj" 1 "wrap.obj:4: a face has the corner 4294967297")
expect(stability_report "." 1 "[.]: has 0 vertices")
expect(stability_report "short.obj" 1 "short.obj:2: ")
expect(stability_report "nan.obj" 1 "nan.obj:1: ")

expect(stability_report "--stiffness-matrix K.mtx --mass-matrix M.mtx" 0 "2 degrees of freedom")
set(K "--mass-matrix M.mtx --stiffness-matrix")
expect(stability_report "${K} shape.mtx" 1 "shape.mtx: .*3 by 3")
expect(stability_report "${K} asymmetric.mtx" 1 "asymmetric.mtx: .*symmetric")
expect(stability_report "${K} above.mtx" 1 "above.mtx, line 4: .*lower triangle")
expect(stability_report "${K} nan.mtx" 1 "nan.mtx, line 4: .*finite")
expect(stability_report "${K} word.mtx" 1 "word.mtx, line 4: ")
expect(stability_report "${K} truncated.mtx" 1 "truncated.mtx, line 3: ends after 1 of 2")
expect(stability_report "${K} K.mtx --size 4" 108 "--size")
expect(stability_report "${K} K.mtx --any-pose" 108 "--any-pose")
set(M "--stiffness-matrix K.mtx --mass-matrix")
expect(stability_report "${M} full.mtx" 1 "full.mtx: .*diagonal")
expect(stability_report "${M} negative.mtx" 1 "negative.mtx: .*mass.1. is -1")
expect(stability_report "${M} M.mtx --damping-matrix shape.mtx" 1 "shape.mtx: .*damping")

expect(stability_report "${cloth} --json missing/report.json" 1
    "--json: missing/report.json cannot be written")
expect(stability_report "${cloth} --html missing/report.html" 1
    "--html: missing/report.html cannot be written")
expect(drape "${cloth} --output triangle.obj/frames" 1 "--output: .*cannot be written")
expect(drape "${cloth} --output frames --duration 1 --step 0.01" 3 "diverged")
expect(drape "${cloth} --output frames --step 1e-12" 1 "--step: ")
expect(drape "${cloth} --output frames --method explicit" 1 "--integrator explicit: .*damping")
expect(drape "${cloth} --output frames --duration 0.1 --quiet" 0 "simulated")
expect(drape "${cloth} --output frames --format stl" 105 "--format")
# A header, 12 bytes for each of 16 particles, 17 for each of 9 quads.
expect(drape "${cloth} --output frames --duration 0.1 --quiet --format ply" 0 "frames/frame_[*].ply")
file(READ ${folder}/frames/frame_00003.ply frame HEX)
string(HEX "end_header\n" end)
string(FIND "${frame}" "${end}" header)
string(LENGTH "${frame}" digits)
math(EXPR bytes "(${digits} - ${header}) / 2 - 11")
if(header LESS 0 OR NOT bytes EQUAL 345)
    message(SEND_ERROR "--format ply: ${bytes} bytes behind the header, expected 345")
endif()
expect(drape "${cloth} --law rubber" 105 "--law")
expect(drape "${cloth} --bending 1e-6" 1 "--bending: .*buckling")
expect(drape "${cloth} --radius 1" 107 "--radius requires --collide")
expect(drape "${cloth} --friction 0.5" 107 "--friction requires --collide")
expect(drape "${cloth} --collide plane --radius 1" 1 "--radius: .*plane")
expect(drape "${cloth} --collide cube" 105 "--collide")
expect(drape "triangle.obj --free" 1 "--free: triangle.obj")
expect(drape "${cloth} --guard --integrator explicit --alpha 1e-4" 1 "--guard: explicit Euler")
expect(drape "${cloth} --output frames --cache missing/cloth.pc2 --quiet" 1
    "--cache: missing/cloth.pc2: cannot be written")

# Every law, integrator and obstacle for some frames. A frame whose energy nobody can explain exits
# with 3. A PC2 header takes 32 bytes, a frame of 16 particles 192.
set(short "--output frames --duration 0.2 --quiet --cache cloth.pc2 --springs")
foreach(law IN ITEMS hookean tension-only buckling)
    foreach(integrator IN ITEMS symplectic verlet implicit newton bdf2 projective)
        expect(drape "${cloth} ${short} --law ${law} --integrator ${integrator}" 0 "law ${law}.*${integrator} steps")
        file(SIZE ${folder}/cloth.pc2 bytes)
        if(NOT bytes EQUAL 1376)
            message(SEND_ERROR "--cache, ${law}, ${integrator}: ${bytes} bytes, expected 1376")
        endif()
        expect(drape "${cloth} ${short} --law ${law} --integrator ${integrator} --guard" 0
            "${integrator}, guarded")
    endforeach()
    expect(drape "${cloth} ${short} --law ${law} --free --collide sphere" 0 "sphere of")
    expect(drape "${cloth} ${short} --law ${law} --free --collide plane --integrator implicit" 0
        "plane through")
endforeach()
expect(drape "${cloth} ${short} --integrator explicit --alpha 1e-4 --step 1e-4" 0 "simulated")
expect(prediction "${cloth}" 0 "grows as predicted")
expect(prediction "${cloth} --stretch 0 --bend 0" 1 "nothing to try")
expect(prediction "${cloth} --pin 0-15" 1 "nothing to try")
expect(prediction "${cloth} --duration 1e6" 1 "--duration: ")

# The hand stays where it should be, springs tear, and none that holds is longer than those that tore.
expect(engine_loop "" 0
    "26[67] ticks, .*\n[1-9][0-9]* springs torn in [1-9].* 1[.]1[0-5] of its rest.*hand within .e-0[6-9]")

# The keys that scripts read.
expect(stability_report "${cloth} --blame 2 --json report.json" 0 "symplectic Euler")
file(READ ${folder}/report.json json)
function(expect_type type)
    string(JSON found ERROR_VARIABLE error TYPE "${json}" ${ARGN})
    if(NOT found STREQUAL type)
        message(SEND_ERROR "JSON ${ARGN}: ${found}, expected ${type} ${error}")
    endif()
endfunction()
foreach(key IN ITEMS degrees_of_freedom particles springs k_min:lower k_max:upper
        symplectic_euler:certified any_pose:certified rayleigh_window:h rayleigh_window:d0
        rayleigh_window:lower rayleigh_window:upper limiting_springs:0:index
        limiting_springs:1:share limiting_particles:0:index limiting_particles:1:share
        seconds:setup seconds:analysis)
    string(REPLACE ":" ";" key ${key})
    expect_type(NUMBER ${key})
endforeach()
expect_type(NULL zero_modes)
expect_type(NULL explicit_euler certified)
expect_type(STRING implicit_euler certified)
expect_type(STRING rayleigh_window method)
expect_type(BOOLEAN rayleigh_window empty)
expect_type(BOOLEAN rayleigh_window includes_zero)
string(JSON unbounded GET "${json}" implicit_euler certified)
if(NOT unbounded STREQUAL "unbounded")
    message(SEND_ERROR "JSON implicit_euler certified: ${unbounded}, expected unbounded")
endif()
