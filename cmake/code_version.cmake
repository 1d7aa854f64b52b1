# SPDX-License-Identifier: Apache-2.0
# cmake -DROOT=... -DOUT=... -P code_version.cmake: writes digests of the sources that decide what a
# stage makes. They are part of the keys of cached entries and of finished runs, so that neither
# outlives a change of the code.
cmake_minimum_required(VERSION 3.25)

function(digest_of variable)
  set(files "")
  foreach(pattern IN LISTS ARGN)
    file(GLOB_RECURSE found ${ROOT}/${pattern})
    list(APPEND files ${found})
  endforeach()
  list(SORT files)
  set(all "")
  foreach(file IN LISTS files)
    file(SHA256 ${file} digest)
    file(RELATIVE_PATH name ${ROOT} ${file})
    string(APPEND all "${name} ${digest}\n")
  endforeach()
  string(SHA256 digest "${all}")
  string(SUBSTRING ${digest} 0 16 digest)
  set(${variable} ${digest} PARENT_SCOPE)
endfunction()

digest_of(LIGHT scenes/*.cpp scenes/*.hpp scenes/categories/*.yaml sim/render/*.cpp sim/render/*.hpp slam/core/*.cpp
          slam/core/*.hpp)
digest_of(RUN slam/*.cpp slam/*.hpp scenes/*.cpp scenes/*.hpp scenes/categories/*.yaml robots/*.cpp robots/*.hpp sim/*.cpp
          sim/*.hpp bench/protocol/*.cpp bench/protocol/*.hpp bench/metrics/*.cpp
          bench/metrics/*.hpp bench/systems/*.cpp bench/systems/*.hpp bench/world/*.cpp
          bench/world/*.hpp bench/run_one.cpp bench/results/occupancy.cpp
          bench/results/trajectory_score.cpp CMakeLists.txt)
execute_process(COMMAND git -C ${ROOT} describe --always --dirty --tags
                OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(commit STREQUAL "")
  set(commit "unknown")  # no git here, or no clone
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT
"// Made by cmake/code_version.cmake.
#pragma once
#define MH_CODE_LIGHT \"${LIGHT}\"
#define MH_CODE_RUN \"${RUN}\"
#define MH_COMMIT \"${commit}\"
")
