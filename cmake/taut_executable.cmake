# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Warnings and sanitizers stay private to Taut's own programs: a user's build is the user's affair.
function(taut_private_flags target)
    if(MSVC)
        target_compile_options(${target} PRIVATE /W4 $<$<BOOL:${TAUT_WERROR}>:/WX>)
    else()
        # Clang counts sign conversions among -Wconversion, GCC does not.
        target_compile_options(${target} PRIVATE
            -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wshadow
            $<$<BOOL:${TAUT_WERROR}>:-Werror>)
        # It looks for what it may forget once in a file and not ten times: a tenth sooner, a tenth more memory.
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=450000>)
    endif()
    if(TAUT_SANITIZE)
        set(flags -fsanitize=${TAUT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
        target_compile_options(${target} PRIVATE ${flags})
        target_link_options(${target} PRIVATE ${flags})
    endif()
endfunction()

# Where there is little beside the headers, which users may compile with it.
function(taut_sign_conversion target)
    if(NOT MSVC)
        target_compile_options(${target} PRIVATE -Wsign-conversion)
    endif()
endfunction()

# TAUT_SAME_BITS for a target, PRIVATE or INTERFACE.
function(taut_same_bits target scope)
    target_compile_definitions(${target} ${scope} TAUT_SAME_BITS EIGEN_FAST_MATH=0)
    target_compile_options(${target} ${scope} $<IF:$<BOOL:${MSVC}>,/fp:precise,-ffp-contract=off>)
endfunction()

function(taut_executable target)
    add_executable(${target} ${ARGN})
    target_link_libraries(${target} PRIVATE Taut::Taut)
    taut_private_flags(${target})
endfunction()

# The same by Taut::Compiled where it is built: for many programs of the common systems.
function(taut_program target)
    taut_executable(${target} ${ARGN})
    if(TARGET Taut::Compiled)
        target_link_libraries(${target} PRIVATE taut_modules Taut::Compiled)
        target_precompile_headers(${target} REUSE_FROM taut_parsed)
    endif()
endfunction()
