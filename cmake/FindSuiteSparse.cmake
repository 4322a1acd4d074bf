# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Defines SuiteSparse::CHOLMOD and SuiteSparse::UMFPACK, the names of SuiteSparse 7's own packages;
# SuiteSparse_MISSING names what was not found. Older releases ship no package: there the headers and
# libraries are searched, and BLAS is linked in front of the one that CHOLMOD was built against,
# since CMake prefers OpenBLAS where both are installed and it is several times faster.

set(SuiteSparse_MISSING "")
foreach(part IN ITEMS CHOLMOD UMFPACK)
    find_package(${part} CONFIG QUIET)
    mark_as_advanced(${part}_DIR)
    if(TARGET SuiteSparse::${part})
        continue()
    endif()
    if(TARGET SuiteSparse::${part}_static)
        add_library(SuiteSparse::${part} INTERFACE IMPORTED)
        target_link_libraries(SuiteSparse::${part} INTERFACE SuiteSparse::${part}_static)
        continue()
    endif()

    string(TOLOWER ${part} name)
    find_path(${part}_INCLUDE_DIR ${name}.h PATH_SUFFIXES suitesparse)
    find_library(${part}_LIBRARY ${name})
    mark_as_advanced(${part}_INCLUDE_DIR ${part}_LIBRARY)
    find_package(BLAS QUIET)
    if(NOT ${part}_INCLUDE_DIR OR NOT ${part}_LIBRARY)
        list(APPEND SuiteSparse_MISSING ${part})
    elseif(BLAS_FOUND)
        add_library(SuiteSparse::${part} UNKNOWN IMPORTED)
        set_target_properties(SuiteSparse::${part} PROPERTIES
            IMPORTED_LOCATION "${${part}_LIBRARY}"
            INTERFACE_INCLUDE_DIRECTORIES "${${part}_INCLUDE_DIR}"
            INTERFACE_LINK_LIBRARIES BLAS::BLAS)
    else()
        list(APPEND SuiteSparse_MISSING BLAS)
    endif()
endforeach()
list(REMOVE_DUPLICATES SuiteSparse_MISSING)
list(JOIN SuiteSparse_MISSING ", " SuiteSparse_MISSING)  # as a list it would not survive below

set(SuiteSparse_LIBRARIES "")
if(NOT SuiteSparse_MISSING)
    set(SuiteSparse_LIBRARIES SuiteSparse::CHOLMOD SuiteSparse::UMFPACK)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse
    REQUIRED_VARS SuiteSparse_LIBRARIES
    REASON_FAILURE_MESSAGE
        "missing: ${SuiteSparse_MISSING} (Debian: libsuitesparse-dev libopenblas-dev)")
