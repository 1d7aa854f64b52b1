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
set(data ${work}/moved/share/modelhouse)
run(${work}/moved/bin/modelhouse scene info ${data}/scenes/model_house/house.yaml)

# What an installed suite names is installed, too.
file(GLOB suites ${data}/bench/suites/*.yaml)
set(named_files 0)
foreach(suite IN LISTS suites)
  file(STRINGS ${suite} lines REGEX "[.][.]/")
  string(REGEX MATCHALL "[.][.]/[-A-Za-z0-9_./]+" names "${lines}")
  foreach(name IN LISTS names)
    math(EXPR named_files "${named_files} + 1")
    if(NOT EXISTS ${data}/bench/suites/${name})
      message(FATAL_ERROR "${suite} names ${name}, which was not installed")
    endif()
  endforeach()
endforeach()
if(named_files EQUAL 0)
  message(FATAL_ERROR "no installed suite names a file")
endif()

run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${work}/build -G Ninja --log-level=WARNING
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${work}/moved
    -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
run(${CMAKE_COMMAND} --build ${work}/build)
run(${work}/build/consumer)
