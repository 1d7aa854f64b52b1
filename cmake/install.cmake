# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where: the program, its data, and the paper's equations as a
# header-only package for find_package(Modelhouse).
include(CMakePackageConfigHelpers)

install(TARGETS modelhouse RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

# Data keep the layout of the sources: suites name their files relative to their own folder.
set(data_dir ${CMAKE_INSTALL_DATADIR}/modelhouse)
foreach(folder assets bench/scenarios bench/suites robots/pepper scenes/model_house scenes/rooms
               sim/sensors/levels)
  install(DIRECTORY ${folder}/ DESTINATION ${data_dir}/${folder})
endforeach()
install(FILES LICENSE README.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Used as #include <modelhouse/semantics/augmented_vector.hpp>.
install(DIRECTORY slam/semantics/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/modelhouse/semantics
        FILES_MATCHING PATTERN "*.hpp")
install(TARGETS mh_semantics EXPORT ModelhouseTargets)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Modelhouse)
install(EXPORT ModelhouseTargets NAMESPACE Modelhouse:: DESTINATION ${package_dir})
configure_package_config_file(cmake/ModelhouseConfig.cmake.in
  ${PROJECT_BINARY_DIR}/ModelhouseConfig.cmake INSTALL_DESTINATION ${package_dir})
# Header-only: any architecture may use what any other installed.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ModelhouseConfigVersion.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/ModelhouseConfig.cmake
              ${PROJECT_BINARY_DIR}/ModelhouseConfigVersion.cmake DESTINATION ${package_dir})
