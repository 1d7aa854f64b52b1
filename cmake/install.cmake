# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` installs, and where: the program, its data, and the paper's equations as a
# header-only package for find_package(Modelhouse).
include(CMakePackageConfigHelpers)

install(TARGETS modelhouse modelhouse-library-host RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

# Data keep the layout of the source tree, since suites refer to files relative to their folder.
set(data_dir ${CMAKE_INSTALL_DATADIR}/modelhouse)
foreach(folder assets bench/live/page bench/report/pages/bundle bench/scenarios bench/studies bench/suites robots/pepper robots/turtlebot3
               scenes/model_house scenes/rooms sim/sensors/levels)
  install(DIRECTORY ${folder}/ DESTINATION ${data_dir}/${folder} COMPONENT data)
endforeach()
install(DIRECTORY examples/ DESTINATION ${data_dir}/examples COMPONENT data PATTERN "__pycache__" EXCLUDE)
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)

set(made ${PROJECT_BINARY_DIR}/made)
install(FILES ${made}/modelhouse.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${made}/completion.bash RENAME modelhouse
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${made}/completion.zsh RENAME _modelhouse
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${made}/completion.fish RENAME modelhouse.fish
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

# To be used by `import modelhouse`, with ${data_dir}/python on PYTHONPATH.
install(DIRECTORY python/modelhouse/ DESTINATION ${data_dir}/python/modelhouse COMPONENT python
        PATTERN "__pycache__" EXCLUDE)
install(TARGETS modelhouse_python LIBRARY DESTINATION ${data_dir}/python/modelhouse COMPONENT python)

# Used as #include <modelhouse/semantics/augmented_vector.hpp>.
install(DIRECTORY slam/semantics/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/modelhouse/semantics
        FILES_MATCHING PATTERN "*.hpp")
install(FILES include/modelhouse/system.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/modelhouse)
install(TARGETS mh_semantics mh_system_header EXPORT ModelhouseTargets)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Modelhouse)
install(EXPORT ModelhouseTargets NAMESPACE Modelhouse:: DESTINATION ${package_dir})
configure_package_config_file(cmake/ModelhouseConfig.cmake.in
  ${PROJECT_BINARY_DIR}/ModelhouseConfig.cmake INSTALL_DESTINATION ${package_dir})
# Header-only: a package installed on one architecture works on all others.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ModelhouseConfigVersion.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/ModelhouseConfig.cmake
              ${PROJECT_BINARY_DIR}/ModelhouseConfigVersion.cmake DESTINATION ${package_dir})
