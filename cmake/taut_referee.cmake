# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# What bench/soundness computes in: MPFR under Boost.Multiprecision.
find_package(Boost QUIET)
find_path(TAUT_MPFR_INCLUDE mpfr.h)
find_library(TAUT_MPFR mpfr)
find_library(TAUT_GMP gmp)
mark_as_advanced(TAUT_MPFR_INCLUDE TAUT_MPFR TAUT_GMP)

function(taut_link_referee target)
    if(NOT Boost_FOUND OR NOT TAUT_MPFR_INCLUDE OR NOT TAUT_MPFR OR NOT TAUT_GMP)
        message(FATAL_ERROR "${target} needs Boost, MPFR and GMP (Debian: libboost-dev libmpfr-dev)")
    endif()
    target_include_directories(${target} SYSTEM PRIVATE ${TAUT_MPFR_INCLUDE})
    target_link_libraries(${target} PRIVATE Boost::headers ${TAUT_MPFR} ${TAUT_GMP})
endfunction()
