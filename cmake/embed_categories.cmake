# SPDX-License-Identifier: Apache-2.0
# Writes ${OUT}: a C++ source with the text of every file in scenes/generate/categories and scenes/generate/floors.
cmake_minimum_required(VERSION 3.25)
file(GLOB files ${ROOT}/scenes/generate/categories/*.yaml ${ROOT}/scenes/generate/floors/*.yaml)
list(SORT files)
set(entries "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND entries "  if (name == \"${name}\") return R\"yaml(${text})yaml\";\n")
endforeach()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT
"// Made by cmake/embed_categories.cmake.
#include <cassert>

#include \"scenes/generate/data.hpp\"

namespace mh {

std::string_view generator_data(std::string_view name) {
@entries@  assert(false);
  return {};
}

}  // namespace mh
")
