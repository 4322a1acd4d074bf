# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# WebAssembly (Debian: emscripten, nodejs); programs run by node.
find_program(empp em++ REQUIRED)
file(REAL_PATH ${empp} empp)
cmake_path(GET empp PARENT_PATH emscripten)
include(${emscripten}/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_CXX_FLAGS_INIT -fexceptions)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fexceptions -s ALLOW_MEMORY_GROWTH=1 -s EXIT_RUNTIME=1 -s NODERAWFS=1")
set(CMAKE_CROSSCOMPILING_EMULATOR node --no-experimental-fetch)  # which this emscripten does not expect
