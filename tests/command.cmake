# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Sets `command` to what comes after `--` on the line of a script that includes this.
set(command "")
set(begun FALSE)
foreach(i RANGE ${CMAKE_ARGC})
    if(begun)
        list(APPEND command ${CMAKE_ARGV${i}})
    elseif("${CMAKE_ARGV${i}}" STREQUAL "--")
        set(begun TRUE)
    endif()
endforeach()
