// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/report/pages/plot.hpp"
#include "bench/report/pages/tables.hpp"

namespace mh {

// Helpers that the figures for papers share, and the figures themselves. Each figure is a gnuplot
// script, made in a source file of its own.

/// The color of the i-th arm.
const char* ink_of(std::size_t i);

/// The arms (systems with labels) of a suite, in its order. An arm's place in this order determines
/// its ink.
class InkOfArms {
 public:
  explicit InkOfArms(const Suite& suite) : suite_(suite), arms_(arms_of(suite)) {}
  /// @throws std::out_of_range if no arm has this system and these labels
  std::size_t place(const std::string& system, const std::string& labels) const {
    for (std::size_t i = 0; i < arms_.size(); ++i)
      if (suite_.systems[arms_[i].system].name == system && arms_[i].labels == labels) return i;
    throw std::out_of_range(system);
  }
  const std::string& name(std::size_t place) const { return arms_[place].name; }
  std::size_t count() const { return arms_.size(); }

 private:
  const Suite& suite_;
  std::vector<Arm> arms_;
};

/// Reads a table that was written for pages (PageTable).
class PlotTable {
 public:
  explicit PlotTable(const nlohmann::ordered_json& json) : json_(json) {}
  std::size_t rows() const { return json_.at("rows").get<std::size_t>(); }
  const nlohmann::ordered_json* column(const std::string& key) const {
    for (const nlohmann::ordered_json& c : json_.at("columns"))
      if (c.at("key") == key) return &c;
    return nullptr;
  }
  std::string text(const std::string& key, std::size_t row) const {
    const nlohmann::ordered_json* c = column(key);
    if (c == nullptr || c->at("values").at(row).is_null()) return "";
    return c->at("words").at(c->at("values").at(row).get<std::size_t>()).get<std::string>();
  }
  std::optional<double> number(const std::string& key, std::size_t row) const {
    const nlohmann::ordered_json* c = column(key);
    if (c == nullptr || c->at("values").at(row).is_null()) return std::nullopt;
    return c->at("values").at(row).get<double>();
  }

 private:
  const nlohmann::ordered_json& json_;
};

/// The first part of a script: terminal, key above, axes to the left and below, a faint grid.
std::string beginning(const PlotOrder& order, const std::filesystem::path& file, double height_cm);

std::string plot_by_density(const PagesSource& source, const PlotOrder& order,
                            const std::filesystem::path& file);
std::string plot_by_frame(const PagesSource& source, const PlotOrder& order,
                          const std::filesystem::path& file);
std::string plot_from_above(const PagesSource& source, const PlotOrder& order,
                            const std::filesystem::path& file);
std::string plot_table(const PagesSource& source, const PlotOrder& order,
                       const std::filesystem::path& file);

}  // namespace mh
