# SPDX-License-Identifier: Apache-2.0
# cmake -DBUILD_DIR=... -DSOURCE_DIR=... -DCOMPILER=... -P consume.cmake
# Installs what was built, moves it elsewhere (a package must not remember where it
# was made), and configures, builds and runs a stranger's project against it.
set(work ${BUILD_DIR}/tests/install)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${work}/made)
file(RENAME ${work}/made ${work}/moved)
if(EXISTS ${work}/moved/bin/modelhouse)
  run(${work}/moved/bin/modelhouse --help)
  file(GLOB suites ${work}/moved/share/modelhouse/bench/suites/*.yaml)
  if(NOT suites)
    message(FATAL_ERROR "no suite was installed")
  endif()
endif()
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${work}/build -G Ninja --log-level=WARNING
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${work}/moved
    -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
run(${CMAKE_COMMAND} --build ${work}/build)
run(${work}/build/consumer)
