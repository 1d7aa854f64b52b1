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

digest_of(LIGHT scenes/*.cpp scenes/*.hpp scenes/categories/*.yaml scenes/floors/*.yaml sim/render/*.cpp sim/render/*.hpp slam/core/*.cpp
          slam/core/*.hpp)
digest_of(DETECT slam/detect/*.cpp slam/detect/*.hpp slam/core/*.cpp slam/core/*.hpp)
digest_of(RUN slam/*.cpp slam/*.hpp scenes/*.cpp scenes/*.hpp scenes/categories/*.yaml scenes/floors/*.yaml robots/*.cpp robots/*.hpp sim/*.cpp
          sim/*.hpp bench/protocol/*.cpp bench/protocol/*.hpp bench/metrics/*.cpp
          bench/metrics/*.hpp bench/systems/*.cpp bench/systems/*.hpp bench/world/*.cpp
          bench/world/*.hpp bench/inputs/inputs.cpp bench/inputs/inputs.hpp bench/inputs/recorded_camera.*
          bench/plan/find_program.* bench/plan/graded_spec.*
          bench/plan/outside_program.* bench/provenance/digest.*
          bench/provenance/input_digest.hpp bench/provenance/place_facts.hpp
          bench/results/call_times.* bench/results/placed.* bench/results/run_result.hpp
          bench/run/hidden.* bench/run/run_one.* include/modelhouse/*.h
          CMakeLists.txt)
digest_of(AUDIT bench/audit/*.cpp bench/audit/*.hpp)
digest_of(EPISODES bench/episodes/*.cpp bench/episodes/*.hpp bench/plan/episodes_spec.*
          bench/studies/laser_scans.*)

# Where git is not installed: what .git says, a worktree's included. Changes in files go unseen.
function(commit_from_files variable)
  set(${variable} "unknown" PARENT_SCOPE)  # no clone
  set(folder ${ROOT}/.git)
  if(EXISTS ${folder} AND NOT IS_DIRECTORY ${folder})
    file(READ ${folder} text)
    string(REGEX MATCH "gitdir: ([^\n]+)" found "${text}")
    get_filename_component(folder "${CMAKE_MATCH_1}" ABSOLUTE BASE_DIR ${ROOT})
  endif()
  if(NOT EXISTS ${folder}/HEAD)
    return()
  endif()
  set(common ${folder})
  if(EXISTS ${folder}/commondir)
    file(READ ${folder}/commondir text)
    string(STRIP "${text}" text)
    get_filename_component(common "${text}" ABSOLUTE BASE_DIR ${folder})
  endif()
  file(READ ${folder}/HEAD head)
  string(STRIP "${head}" head)
  if(head MATCHES "^ref: (.+)$")
    set(ref ${CMAKE_MATCH_1})
    set(head "")
    if(EXISTS ${common}/${ref})
      file(READ ${common}/${ref} head)
      string(STRIP "${head}" head)
    elseif(EXISTS ${common}/packed-refs)
      file(STRINGS ${common}/packed-refs lines)
      foreach(line IN LISTS lines)
        if(line MATCHES "^([0-9a-f]+) (.+)$" AND CMAKE_MATCH_2 STREQUAL ref)
          set(head ${CMAKE_MATCH_1})
        endif()
      endforeach()
    endif()
  endif()
  if(head MATCHES "^[0-9a-f]+$")
    string(SUBSTRING ${head} 0 7 head)
    set(${variable} "${head} (by .git alone: changed files are not seen)" PARENT_SCOPE)
  endif()
endfunction()

execute_process(COMMAND git -C ${ROOT} describe --always --dirty --tags
                OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(commit STREQUAL "")
  commit_from_files(commit)
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT
"// Made by cmake/code_version.cmake.
#pragma once
#define MH_CODE_LIGHT \"${LIGHT}\"
#define MH_CODE_DETECT \"${DETECT}\"
#define MH_CODE_RUN \"${RUN}\"
#define MH_CODE_AUDIT \"${AUDIT}\"
#define MH_CODE_EPISODES \"${EPISODES}\"
#define MH_COMMIT \"${commit}\"
")
