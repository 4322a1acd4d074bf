# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# The text with # for each number: numbers depend on the compiler's rounding.
function(without_numbers text result)
    string(REGEX REPLACE "[-+]?[0-9][0-9.]*(e[-+]?[0-9]+)?" "#" text "${text}")
    set(${result} "${text}" PARENT_SCOPE)
endfunction()
