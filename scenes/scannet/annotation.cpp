// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/annotation.hpp"

#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/io/error.hpp"
#include "slam/io/json_text.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();

/// Collects the numbers in the array segIndices of the outermost object, without building a tree of
/// millions of values.
class SegmentsHandler : public nlohmann::json_sax<Json> {
 public:
  explicit SegmentsHandler(const std::string& name) : name_(name) {}

  std::vector<std::uint32_t> segments;
  bool found = false;

  bool null() override { return other(); }
  bool boolean(bool) override { return other(); }
  bool number_integer(number_integer_t value) override {
    if (inside_) fail(fmt::format("segment {} is negative", value));
    return true;
  }
  bool number_unsigned(number_unsigned_t value) override {
    if (!inside_) return true;
    if (value > kMost) fail(fmt::format("segment {} is more than 32 bits", value));
    segments.push_back(static_cast<std::uint32_t>(value));
    return true;
  }
  bool number_float(number_float_t, const string_t&) override { return other(); }
  bool string(string_t&) override { return other(); }
  bool binary(binary_t&) override { return other(); }
  bool start_object(std::size_t) override {
    ++depth_;
    return other();
  }
  bool key(string_t& key) override {
    wanted_ = depth_ == 1 && key == "segIndices";
    return true;
  }
  bool end_object() override {
    --depth_;
    return true;
  }
  bool start_array(std::size_t) override {
    other();
    if (std::exchange(wanted_, false)) inside_ = found = true;
    ++depth_;
    return true;
  }
  bool end_array() override {
    --depth_;
    inside_ = false;
    return true;
  }
  bool parse_error(std::size_t, const std::string&,
                   const nlohmann::detail::exception& error) override {
    fail(json_fault(error));
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", name_, what));
  }
  bool other() const {
    if (inside_) fail(fmt::format("segIndices[{}] is not an integer", segments.size()));
    return true;
  }

  const std::string& name_;
  int depth_ = 0;
  bool wanted_ = false, inside_ = false;
};

std::uint32_t read_id(const Json& value, const char* what) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMost)
    throw InputError(fmt::format("{}: {} is not an id", what,
                                 value.is_number() ? value.dump() : value.type_name()));
  return value.get<std::uint32_t>();
}

SegmentGroup read_group(const Json& item) {
  SegmentGroup group;
  group.object = read_id(item.at(item.contains("objectId") ? "objectId" : "id"), "objectId");
  group.category = item.at("label").get<std::string>();
  if (item.contains("name")) group.name = item.at("name").get<std::string>();
  for (const Json& segment : item.at("segments"))
    group.segments.push_back(read_id(segment, "segment"));
  return group;
}

}  // namespace

std::vector<std::uint32_t> parse_segments(std::string_view json, const std::string& name) {
  SegmentsHandler handler(name);
  Json::sax_parse(json.begin(), json.end(), &handler);
  if (!handler.found) throw InputError(fmt::format("{}: has no array segIndices", name));
  return std::move(handler.segments);
}

std::vector<SegmentGroup> parse_aggregation(std::string_view json, const std::string& name) {
  std::vector<SegmentGroup> groups;
  std::map<std::uint32_t, std::size_t> place_of;  // by objectId
  try {
    const Json root = parse_json<Json>(json);
    for (const Json& item : root.at("segGroups")) try {
        SegmentGroup group = read_group(item);
        const auto [first, is_new] = place_of.try_emplace(group.object, groups.size());
        if (!is_new)
          throw InputError(fmt::format("objectId {} is that of segGroups[{}] already", group.object,
                                       first->second));
        groups.push_back(std::move(group));
      } catch (const Json::exception& error) {
        throw InputError(fmt::format("segGroups[{}]: {}", groups.size(), json_fault(error)));
      } catch (const InputError& error) {
        throw InputError(fmt::format("segGroups[{}]: {}", groups.size(), error.what()));
      }
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: {}", name, json_fault(error)));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", name, error.what()));
  }
  return groups;
}

std::string segments_text(const std::vector<std::uint32_t>& segment_of_vertex,
                          const std::string& scene_id) {
  return fmt::format("{{\"params\":{{}},\"sceneId\":{},\"segIndices\":[{}]}}\n",
                     Json(scene_id).dump(), fmt::join(segment_of_vertex, ","));
}

std::string aggregation_text(const std::vector<SegmentGroup>& groups, const std::string& scene_id) {
  Json list = Json::array();
  for (const SegmentGroup& group : groups) {
    // In ScanNet's own files, id and objectId are the same.
    Json item = {{"id", group.object},
                 {"objectId", group.object},
                 {"segments", group.segments},
                 {"label", group.category}};
    if (!group.name.empty()) item["name"] = group.name;
    list.push_back(std::move(item));
  }
  const Json root = {
      {"sceneId", "scannet." + scene_id},
      {"appId", "Modelhouse"},
      {"segGroups", std::move(list)},
      {"segmentsFile", fmt::format("scannet.{}_vh_clean_2.0.010000.segs.json", scene_id)}};
  return root.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mh
