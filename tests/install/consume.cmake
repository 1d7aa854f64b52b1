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

# From anywhere the program finds what was installed with it, and not the sources it was made from.
set(program ${work}/moved/bin/modelhouse)
set(elsewhere ${work}/elsewhere)
file(MAKE_DIRECTORY ${elsewhere})
file(COPY_FILE ${data}/sim/sensors/levels/ideal.yaml ${data}/sim/sensors/levels/installed.yaml)
run(${program} scene info model_house WORKING_DIRECTORY ${elsewhere})
run(${program} drive model_house model_house/query --out drive WORKING_DIRECTORY ${elsewhere})
execute_process(COMMAND ${program} render office auto --level instaled --out render
                WORKING_DIRECTORY ${elsewhere} ERROR_VARIABLE told RESULT_VARIABLE code)
if(NOT code EQUAL 2 OR NOT told MATCHES "did you mean 'installed'")
  message(FATAL_ERROR "a level beside the installed ones was not found: ${told}")
endif()
run(${program} bench model_house --frames 20 --trials 1 --out bench --cache ${BUILD_DIR}/cache_of_tests
    WORKING_DIRECTORY ${elsewhere})
file(STRINGS ${elsewhere}/bench/table.txt table)
if(NOT table MATCHES "the paper's system")
  message(FATAL_ERROR "no table: ${table}")
endif()

# So does the Python package.
run(${CMAKE_COMMAND} -E env PYTHONPATH=${data}/python PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c
    "import modelhouse as mh; sim = mh.Simulation('model_house', level='installed', cache='${BUILD_DIR}/cache_of_tests'); assert sim.step(0, 0, 0).color.shape == (480, 640, 3); mh.Slam(sim.camera)"
    WORKING_DIRECTORY ${elsewhere})

# Documents, examples, manual page and completion are there, too.
foreach(file doc/Modelhouse/README.md doc/Modelhouse/docs/tutorial.md
             modelhouse/examples/python_slam/odometry.py man/man1/modelhouse.1
             bash-completion/completions/modelhouse zsh/site-functions/_modelhouse
             fish/vendor_completions.d/modelhouse.fish)
  file(SIZE ${work}/moved/share/${file} size)
  if(size EQUAL 0)
    message(FATAL_ERROR "${file} was installed empty")
  endif()
endforeach()

# What an installed suite names is installed, too.
file(GLOB suites ${data}/bench/suites/*.yaml ${data}/bench/studies/*.yaml)
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

# The installed program runs the stranger's system.
file(READ ${data}/examples/visual_odometry/suite.yaml suite)
string(REGEX REPLACE "systems:.*labels:" "systems: [{name: standing, library: ${work}/build/libstanding.so}]\nlabels:" suite "${suite}")
file(WRITE ${data}/examples/visual_odometry/standing.yaml "${suite}")
run(${program} bench ${data}/examples/visual_odometry/standing.yaml --frames 20 --out standing
    --cache ${BUILD_DIR}/cache_of_tests WORKING_DIRECTORY ${elsewhere})
file(STRINGS ${elsewhere}/standing/table.txt table)
if(NOT table MATCHES "standing")
  message(FATAL_ERROR "no row of the stranger's system: ${table}")
endif()
