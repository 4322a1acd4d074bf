# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D SITE=FOLDER -D CHROMIUM=PROGRAM -D WORK=FOLDER -P check_site.cmake
# Reads every page of the site as on a phone, 360 px wide, from its files and without a network: check_site.js says
# what must hold. A window has a least width, a frame in it has none.
cmake_minimum_required(VERSION 3.21)
file(GLOB pages RELATIVE ${SITE} ${SITE}/*.html)
list(LENGTH pages count)
if(count LESS 50)
    message(FATAL_ERROR "${SITE} holds ${count} pages alone: build the target docs first")
endif()
list(JOIN pages "\", \"" names)
file(READ ${CMAKE_CURRENT_LIST_DIR}/check_site.js script)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
file(WRITE ${WORK}/phone.html "<!DOCTYPE html><title>reading</title><body><iframe style=\"width: 360px; height: 740px;
border: 0\"></iframe><script>const SITE = \"file://${SITE}/\";\nconst PAGES = [\"${names}\"];\n${script}</script></body>")
# DNS leads nowhere, so that what a page fetches from elsewhere is missing.
execute_process(
    COMMAND ${CHROMIUM} --headless=new --no-sandbox --disable-gpu --allow-file-access-from-files
        "--host-resolver-rules=MAP * ~NOTFOUND" --user-data-dir=${WORK}/profile --window-size=800,900
        --virtual-time-budget=3600000 --dump-dom file://${WORK}/phone.html
    TIMEOUT 900 RESULT_VARIABLE result OUTPUT_VARIABLE dom ERROR_VARIABLE error)
if(NOT result EQUAL 0 OR NOT dom MATCHES "<title>good: ([^<]*)</title>")
    string(REGEX MATCH "<title>wrong: ([^<]*)" title "${dom}")
    if(title)
        set(error "")  # chromium complains of much that a container lacks
    endif()
    message(FATAL_ERROR "The site on a phone, chromium's exit code ${result}:\n${CMAKE_MATCH_1}\n${error}")
endif()
message(STATUS "The site on a phone, 360 px wide: ${CMAKE_MATCH_1}")
