// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/page_table.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "bench/suite/json_fields.hpp"

namespace mh {

using Json = nlohmann::ordered_json;

PageColumn column_of(const Metric& metric, std::string title) {
  if (title.empty()) title = metric.heading.empty() ? metric.name : std::string(metric.heading);
  return {.key = metric.name,
          .title = std::move(title),
          .unit = std::string(metric.unit),
          .decimals = metric.decimals};
}

PageTable::Column& PageTable::column(const PageColumn& about, bool is_text) {
  const auto [place, is_new] = place_of_.try_emplace(about.key, columns_.size());
  if (is_new) columns_.push_back({about, is_text});
  return columns_[place->second];
}

void PageTable::text(const PageColumn& about, std::string_view value) {
  Column& c = column(about, true);
  auto word = c.index_of.find(value);
  if (word == c.index_of.end()) {
    word = c.index_of.emplace(value, c.words.size()).first;
    c.words.emplace_back(value);
  }
  c.word_of.resize(rows_);
  c.word_of[rows_ - 1] = word->second;
}

void PageTable::number(const PageColumn& about, const std::optional<double>& value) {
  Column& c = column(about, false);
  c.numbers.resize(rows_);
  c.numbers[rows_ - 1] = value;
}

void PageTable::figures(const std::vector<Figure>& figures, const std::string& prefix,
                        const std::string& title_prefix) {
  for (const Figure& figure : figures) {
    PageColumn about = column_of(figure.metric);
    about.key = prefix + about.key;
    about.title = title_prefix + about.title;
    number(about, figure.value);
  }
}

Json PageTable::json() const {
  Json columns = Json::array();
  for (const Column& c : columns_) {
    Json json = {{"key", c.about.key}, {"title", c.about.title}};
    if (c.about.is_hidden) json["hidden"] = true;
    Json values = Json::array();
    if (c.is_text) {
      json["words"] = c.words;
      for (std::size_t row = 0; row < rows_; ++row)
        values.push_back(row < c.word_of.size() && c.word_of[row] ? Json(*c.word_of[row]) : Json());
    } else {
      json["unit"] = c.about.unit;
      json["decimals"] = c.about.decimals;
      for (std::size_t row = 0; row < rows_; ++row)
        values.push_back(row < c.numbers.size() ? page_number(c.numbers[row]) : Json());
    }
    json["values"] = std::move(values);
    columns.push_back(std::move(json));
  }
  return {{"title", title_}, {"note", note_}, {"rows", rows_}, {"columns", std::move(columns)}};
}

Json page_number(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return json_of(value);
  const double rounded = std::strtod(fmt::format("{:.7g}", *value).c_str(), nullptr);
  if (rounded == std::trunc(rounded) && std::abs(rounded) < 1e15)
    return static_cast<std::int64_t>(rounded);
  return rounded;
}

std::string script_json(const Json& json) {
  std::string safe;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    if (c == '<')
      safe += "\\u003c";
    else if (c == '&')
      safe += "\\u0026";
    else
      safe += c;
  return safe;
}

std::string script_of(const std::string& piece, const Json& json) {
  return fmt::format("(globalThis.modelhouse?\?={{}})[{}]={};\n", script_json(piece),
                     script_json(json));
}

bool is_script_of_data(std::string_view content) {
  return content.starts_with("(globalThis.modelhouse?\?={})[");
}

}  // namespace mh
