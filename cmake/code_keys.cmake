# SPDX-License-Identifier: Apache-2.0
# Digests of the code, recomputed by each build: part of the keys of results and of cache entries.
get_property(bits GLOBAL PROPERTY MH_BITS)
set(lines "BITS|${bits}\n")
foreach(key LIGHT DETECT RUN AUDIT)
  get_property(patterns GLOBAL PROPERTY MH_DECIDES_${key})
  foreach(pattern IN LISTS patterns)
    string(APPEND lines "${key}|${pattern}\n")
  endforeach()
endforeach()
set(made ${PROJECT_BINARY_DIR}/made)
file(CONFIGURE OUTPUT ${made}/decides.txt CONTENT "${lines}")
add_custom_target(code_version BYPRODUCTS ${made}/code_version_made.hpp
  COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DOUT=${made}/code_version_made.hpp
          -DDECIDES=${made}/decides.txt
          -P ${PROJECT_SOURCE_DIR}/cmake/code_version.cmake)
