# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# cmake -D BUILD=... -D GENERATOR=... -D CXX=... -D EIGEN=... -D CONFIG=... -D WORK=... -P check_tutorial.cmake
# Installs Taut into WORK, and builds and runs there the project that docs/tutorial.md shows.
file(REMOVE_RECURSE ${WORK})

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(config "")
if(CONFIG)
    set(config --config ${CONFIG})
endif()
run(${CMAKE_COMMAND} --install ${BUILD} ${config} --prefix ${WORK}/taut)

set(my_cloth ${WORK}/my_cloth)
file(COPY ${CMAKE_CURRENT_LIST_DIR}/tutorial/CMakeLists.txt ${CMAKE_CURRENT_LIST_DIR}/tutorial/cloth.cpp
    DESTINATION ${my_cloth})
run(${CMAKE_COMMAND} -S ${my_cloth} -B ${my_cloth}/build -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
    -D Eigen3_DIR=${EIGEN} -D CMAKE_PREFIX_PATH=${WORK}/taut -D CMAKE_BUILD_TYPE=${CONFIG})
run(${CMAKE_COMMAND} --build ${my_cloth}/build ${config})
find_program(cloth NAMES cloth PATHS ${my_cloth}/build ${my_cloth}/build/${CONFIG} NO_DEFAULT_PATH
    REQUIRED)
run(${cloth})
