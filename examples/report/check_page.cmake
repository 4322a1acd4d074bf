# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D stability_report=... -D chromium=... -D folder=... -P check_page.cmake
# Pages of a cloth, of bare matrices and of a scene without freedom, drawn and used in Chromium
# without a window, at the width of a desk and of a phone. Writes into folder only.

cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

# Writes name.html, and name_check.html: the same with check.js behind it. Sets `table` to what the
# program printed.
function(make_page name)
    execute_process(COMMAND ${stability_report} ${ARGN} --html ${name}.html
        WORKING_DIRECTORY ${folder} RESULT_VARIABLE result OUTPUT_VARIABLE output
        ERROR_VARIABLE error)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${name}: exit code ${result}\n${error}${output}")
    endif()
    set(table "${output}" PARENT_SCOPE)

    file(READ ${folder}/${name}.html page)
    string(REPLACE "http://www.w3.org/2000/svg" "" rest "${page}")
    if(rest MATCHES "https?:|src=|href=|@import|url\\([^#$]")
        message(SEND_ERROR "${name}.html names something outside itself: ${CMAKE_MATCH_0}")
    endif()
    file(READ ${CMAKE_CURRENT_LIST_DIR}/painted.js painted)
    file(READ ${CMAKE_CURRENT_LIST_DIR}/check.js check)
    string(REPLACE "<head>" "<head><script>const pageErrors = [];
        addEventListener('error', (event) => pageErrors.push(event.message));
        console.error = (...words) => pageErrors.push(words.join(' '));</script>" page "${page}")
    string(REPLACE "</body>" "<script>${painted}${check}</script></body>" page "${page}")
    file(WRITE ${folder}/${name}_check.html "${page}")
endfunction()

# The page, laid out `width` wide, must pass check.js, and hide exactly the figures in `hidden`.
# A window has a least width, a frame in it has none.
function(expect_page name width hidden)
    file(READ ${folder}/${name}_check.html page)
    string(REPLACE "&" "&amp;" page "${page}")
    string(REPLACE "\"" "&quot;" page "${page}")
    file(WRITE ${folder}/frame.html "<!DOCTYPE html><body><iframe style=\"width: ${width}px;
        height: 900px\" srcdoc=\"${page}\"></iframe><script>
        setInterval(() => { const told = document.querySelector('iframe').contentDocument
            .documentElement.dataset; document.title = `check: \${told.check}, hidden: \${told.hidden},
            numbers: \${told.numbers}`; }, 100)</script></body>")
    execute_process(COMMAND ${chromium} --headless=new --no-sandbox --disable-gpu
            --user-data-dir=${folder}/profile --window-size=1400,1000
            --virtual-time-budget=20000 --dump-dom file://${folder}/frame.html
        TIMEOUT 120 RESULT_VARIABLE result OUTPUT_VARIABLE dom ERROR_VARIABLE error)
    string(REGEX MATCH "<title>[^<]*" title "${dom}")
    set(title "${title}" PARENT_SCOPE)
    if(NOT result EQUAL 0 OR NOT title MATCHES "^<title>check: good, hidden: ${hidden},")
        message(SEND_ERROR "${name}.html at ${width} px, chromium's exit code ${result}:\n${title}")
    endif()
endfunction()

make_page(cloth --scene hanging_cloth --size 12 --want-step 0.01)
expect_page(cloth 1280 "resolution")
string(REGEX MATCH "symplectic Euler +([0-9.e-]+ s) +([0-9.e-]+ s)" row "${table}")
if(NOT row OR NOT title MATCHES "; ${CMAKE_MATCH_1}; ${CMAKE_MATCH_2}; ")
    message(SEND_ERROR "cloth.html does not hold the numbers that are printed: ${row}\n${title}")
endif()
expect_page(cloth 390 "resolution")

make_page(fewer --scene hanging_cloth --size 40 --stretch 40 --bend 0.4 --resolve 10% --duration 0.3)
if(NOT table MATCHES "times cheaper than all 1600" OR NOT table MATCHES "off by [0-9.]+ %")
    message(SEND_ERROR "fewer: the table says nothing of fewer particles: ${table}")
endif()
expect_page(fewer 1280 "")
expect_page(fewer 390 "")

set(real "%%MatrixMarket matrix coordinate real")
file(WRITE ${folder}/M.mtx "${real} general\n2 2 2\n1 1 1\n2 2 1\n")
file(WRITE ${folder}/K.mtx "${real} symmetric\n2 2 3\n1 1 2\n2 1 -1\n2 2 2\n")
make_page(matrices --stiffness-matrix K.mtx --mass-matrix M.mtx)
expect_page(matrices 390 "runs,springs,resolution")

# A fishing net: lines alone.
set(net "")
foreach(r RANGE 29)
    foreach(c RANGE 29)
        string(APPEND net "v ${c} 0 ${r}\n")
    endforeach()
endforeach()
foreach(r RANGE 29)
    set(along "l")
    set(across "l")
    foreach(c RANGE 29)
        math(EXPR i "30 * ${r} + ${c} + 1")
        math(EXPR j "30 * ${c} + ${r} + 1")
        string(APPEND along " ${i}")
        string(APPEND across " ${j}")
    endforeach()
    string(APPEND net "${along}\n${across}\n")
endforeach()
file(WRITE ${folder}/net.obj "${net}")
make_page(net net.obj --pin 0-29)
expect_page(net 390 "resolution")

make_page(pinned --scene hanging_cloth --size 4 --pin 0-15)
expect_page(pinned 390 "runs,multipliers,springs,window,resolution")
