// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/system_spec.hpp"

#include <fmt/format.h>

#include "bench/suite/names.hpp"
#include "slam/config/by_name.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

/// The names by which a suite may call our own systems.
constexpr Names<SystemKind, 2> kOurs{words(SystemKind{})[0], words(SystemKind{})[1]};
static_assert(name_of(SystemKind::kOutside, kOurs) == "?");

void read_limits(YamlReader& node, OutsideProgram& program) {
  limits(program, [&](const char* key, double& value, const SettingRange& range, const char*,
                      std::optional<OutsideMode> only) {
    const auto limit = node.find(key);
    if (!limit) return;
    if (only && *only != program.mode)
      limit->fail(fmt::format("applies only to protocol '{}'", name(*only)));
    MappingReader::read(*limit, value, range);
  });
}

void read_library(YamlReader& node, OutsideProgram& program, const SuitePaths& paths) {
  program.mode = OutsideMode::kConversation;
  program.library = node.string("library");
  if (program.library.empty()) node.at("library").fail("is empty");
  for (const char* key : {"command", "protocol"})
    if (const auto other = node.find(key)) other->fail("is for a command, but this is a library");
  if (const auto settings = node.find("settings")) {
    named_file(*settings, paths);
    program.settings = settings->as_string();
  }
}

/// One system for each combination of the values of the command's own placeholders.
std::vector<SystemSpec> varied(const SystemSpec& spec, YamlReader vary) {
  std::vector<SystemSpec> all{spec};
  for (const auto& [placeholder, list] : vary.entries()) {
    const std::vector<YamlReader> values = list.items();
    if (values.empty()) list.fail("has no value");
    if (fill_in(spec.outside->command, placeholder, "") == spec.outside->command)
      list.fail(fmt::format("{{{}}} is not in the command", placeholder));
    std::vector<SystemSpec> more;
    for (const SystemSpec& one : all)
      for (const YamlReader& value : values) {
        SystemSpec& with = more.emplace_back(one);
        with.name += fmt::format("_{}_{}", placeholder, value.as_string());
        check_folder_name(value, with.name);
        with.outside->name = with.name;
        with.outside->command = fill_in(one.outside->command, placeholder, value.as_string());
      }
    all = std::move(more);
  }
  return all;
}

/// Reads one of our systems under another name.
void read_variant(YamlReader& node, SystemSpec& spec) {
  spec.kind = one_of(node.at("system"), kOurs);
  YamlReader slam = node.at("slam");
  read_slam_config(slam);  // checks the names and values
  slam.finish();
  for (auto& [section, keys] : slam.entries()) {
    if (section == "base")
      spec.settings.emplace_back("relocalize.acceptance", keys);
    else
      for (const auto& [key, value] : keys.entries())
        spec.settings.emplace_back(section + "." + key, value);
  }
  if (spec.settings.empty()) slam.fail("sets nothing: it would be '" + node.string("system") + "'");
  node.finish();
}

}  // namespace

std::vector<SystemSpec> read_systems(YamlReader node, const SuitePaths& paths) {
  SystemSpec spec;
  if (!node.is_map()) {
    spec.kind = one_of(node, kOurs);
    spec.name = name(spec.kind);
    return {spec};
  }
  spec.name = node.string("name");
  check_folder_name(node.at("name"), spec.name);
  if (value_of(spec.name, kOurs))
    node.at("name").fail("'" + spec.name + "' is one of Modelhouse's own systems");
  if (node.has("system")) {
    read_variant(node, spec);
    return {spec};
  }
  spec.kind = SystemKind::kOutside;
  OutsideProgram& program = spec.outside.emplace();
  program.name = spec.name;
  program.folder = paths.folder.empty() ? "." : paths.folder;
  const bool is_library = node.find("library").has_value();
  const char* key = is_library ? "library" : "command";
  program.place = fmt::format("{}:{}", node.file(), node.at(key).line());
  if (is_library) {
    read_library(node, program, paths);
  } else {
    program.command = node.string("command");
    program.mode = one_of(node.at("protocol"), words(OutsideMode{}));
  }
  read_limits(node, program);
  if (const auto inputs = node.find("inputs"))
    for (const YamlReader& input : inputs->items()) {
      named_file(input, paths);
      program.inputs.push_back(input.as_string());
    }
  spec.repeatable = node.boolean("repeatable", spec.repeatable);
  std::vector<SystemSpec> all{spec};
  if (const auto vary = node.find("vary")) {
    if (is_library) vary->fail("is for a command: a library reads its `settings`");
    all = varied(spec, *vary);
  }
  node.finish();
  try {
    for (const SystemSpec& one : all) validate(*one.outside);
  } catch (const InputError& error) {
    node.at(key).fail(error.what());
  }
  return all;
}

}  // namespace mh
