# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# The code in the README is examples/01_first_step.cpp, from its first comment on.
file(READ ${CMAKE_CURRENT_LIST_DIR}/01_first_step.cpp example)
file(READ ${CMAKE_CURRENT_LIST_DIR}/../README.md readme)
string(FIND "${example}" "// A cloth" start)
string(SUBSTRING "${example}" ${start} -1 example)
string(FIND "${readme}" "```cpp\n${example}```" found)
if(start EQUAL -1 OR found EQUAL -1)
    message(FATAL_ERROR "README.md does not show examples/01_first_step.cpp as it is")
endif()
