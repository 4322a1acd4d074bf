# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# No header uses a name of macros.txt: every one becomes a macro that leaves a mark, once what the headers
# include from elsewhere has been read, and the preprocessor's output must hold no mark.
#   cmake -D INCLUDE=DIR -D LIST=macros.txt -D WORK=DIR -P macros.cmake -- COMPILER FLAGS...
include(${CMAKE_CURRENT_LIST_DIR}/../command.cmake)

file(GLOB_RECURSE headers RELATIVE ${INCLUDE} ${INCLUDE}/taut/*.hpp)
set(elsewhere "")
list(FILTER headers EXCLUDE REGEX "taut/(suitesparse|modal)/")  # their libraries may not be here
foreach(header IN LISTS headers)
    file(STRINGS ${INCLUDE}/${header} found REGEX "^#include <")
    list(APPEND elsewhere ${found})
endforeach()
list(REMOVE_DUPLICATES elsewhere)
set(unit "#include <cassert>\n")
foreach(line IN LISTS elsewhere)
    string(REGEX MATCH "<.*>" name "${line}")
    string(APPEND unit "#if __has_include(${name})\n${line}\n#endif\n")
endforeach()

file(STRINGS ${LIST} lines REGEX "^[^#]")
string(REPLACE ";" " " names "${lines}")
separate_arguments(names)
foreach(name IN LISTS names)
    string(REPLACE "()" "" bare ${name})
    string(REPLACE "()" "(...)" pattern ${name})
    string(APPEND unit "#undef ${bare}\n#define ${pattern} marked_${bare}\n")
endforeach()
foreach(header IN LISTS headers)
    string(APPEND unit "#include <${header}>\n")
endforeach()
# That marks are seen at all.
string(APPEND unit "near max(1, 2) (max)(1, 2)\n")
file(WRITE ${WORK}/macros.cpp "${unit}")
execute_process(COMMAND ${command} -E -o ${WORK}/macros.ii ${WORK}/macros.cpp COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${WORK}/macros.ii marked REGEX "marked_")
if(NOT marked STREQUAL "marked_near marked_max (max)(1, 2)")
    string(REPLACE ";" "\n" marked "${marked}")
    message(FATAL_ERROR "A header of Taut uses a name that is a macro elsewhere:\n${marked}")
endif()
