// SPDX-License-Identifier: Apache-2.0
#include "bench/live/foxglove.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/io/error.hpp"
#include "slam/io/json_text.hpp"

namespace mh {
namespace {

using Ordered = nlohmann::ordered_json;

constexpr char kMessageData = 1;  // the same in both directions
constexpr std::size_t kMostPublished = 64;
constexpr const char* kCommandTopic = "/cmd_vel";

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// An id as the protocol has them: a whole number of 32 bits.
std::optional<std::uint32_t> id_of(const Ordered& json) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > UINT32_MAX) return std::nullopt;
  return json.get<std::uint32_t>();
}

/// An object's list, or an empty one.
const Ordered& list_of(const Ordered& json, const char* key) {
  static const Ordered kNone = Ordered::array();
  const auto found = json.find(key);
  return found != json.end() && found->is_array() ? *found : kNone;
}

FoxgloveClient::Heard refused(const std::string& why) {
  return {.answer = foxglove_error(why)};
}

ros::Twist twist_of(std::string_view bytes, const std::string& encoding) {
  if (encoding == "cdr") return ros::parsed<ros::Twist>(bytes, ros::Wire::kCdr);
  const Ordered json = parse_json_or_discard<Ordered>(bytes);
  const auto number = [&](const char* part, const char* axis) {
    const Ordered::json_pointer at(fmt::format("/{}/{}", part, axis));
    if (!json.is_object() || !json.contains(at) || !json.at(at).is_number())
      throw InputError(fmt::format("has no number {}.{}", part, axis));
    return json.at(at).get<double>();
  };
  return {{number("linear", "x"), number("linear", "y"), 0}, {0, 0, number("angular", "z")}};
}

}  // namespace

std::string foxglove_error(const std::string& why) {
  constexpr int kError = 2;
  return Ordered{{"op", "status"}, {"level", kError}, {"message", why}}.dump();
}

std::vector<std::string> FoxgloveClient::greeting() const {
  // Clients choose panels and datatypes by the distribution: message types are alike in all.
  const Ordered info = {{"op", "serverInfo"},
                        {"name", "modelhouse"},
                        {"capabilities", {"clientPublish"}},
                        {"supportedEncodings", {"cdr", "json"}},
                        {"metadata", {{"ROS_DISTRO", "humble"}}}};
  Ordered channels = Ordered::array();
  for (std::size_t i = 0; i < topics_.size(); ++i)
    channels.push_back({{"id", i},
                        {"topic", topics_[i].name},
                        {"encoding", "cdr"},
                        {"schemaName", ros::type_name(topics_[i].type, ros::Wire::kCdr)},
                        {"schema", topics_[i].definition},
                        {"schemaEncoding", "ros2msg"}});
  return {info.dump(), Ordered{{"op", "advertise"}, {"channels", channels}}.dump()};
}

FoxgloveClient::Heard FoxgloveClient::take_text(std::string_view text) {
  const Ordered json = parse_json_or_discard<Ordered>(text);
  if (!json.is_object() || !json.contains("op") || !json["op"].is_string())
    return refused("expected an object with a text 'op'");
  const std::string op = json["op"];
  Heard heard;
  if (op == "subscribe") {
    for (const Ordered& wanted : list_of(json, "subscriptions")) {
      const auto id =
          wanted.is_object() && wanted.contains("id") ? id_of(wanted["id"]) : std::nullopt;
      const auto topic = wanted.is_object() && wanted.contains("channelId")
                             ? id_of(wanted["channelId"])
                             : std::nullopt;
      if (!id || !topic || *topic >= topics_.size())
        return refused("subscribe: expected ids of a subscription and of one of the channels");
      subscription_of_[*topic] = *id;
      heard.begun.push_back(*topic);
    }
    return heard;
  }
  if (op == "unsubscribe") {
    for (const Ordered& id : list_of(json, "subscriptionIds"))
      std::erase_if(subscription_of_, [&](const auto& s) { return id_of(id) == s.second; });
    return heard;
  }
  if (op == "advertise") {
    for (const Ordered& channel : list_of(json, "channels")) {
      const auto text_of = [&](const char* key) {
        return channel.is_object() && channel.contains(key) && channel[key].is_string()
                   ? channel[key].get<std::string>()
                   : std::string();
      };
      const auto id =
          channel.is_object() && channel.contains("id") ? id_of(channel["id"]) : std::nullopt;
      const std::string topic = text_of("topic"), encoding = text_of("encoding");
      if (!id || topic.empty() || published_.size() >= kMostPublished)
        return refused("advertise: expected at most 64 channels, each with an id and a topic");
      if (encoding != "cdr" && encoding != "json")
        return refused(fmt::format("advertise {}: encoding '{}' is neither cdr nor json",
                                   printable(topic), printable(encoding)));
      published_[*id] = {topic, encoding};
    }
    return heard;
  }
  if (op == "unadvertise") {
    for (const Ordered& id : list_of(json, "channelIds"))
      if (const auto known = id_of(id)) published_.erase(*known);
    return heard;
  }
  return refused(fmt::format("op '{}': is not supported", printable(op)));
}

FoxgloveClient::Heard FoxgloveClient::take_binary(std::string_view bytes) const {
  constexpr std::size_t kHeadBytes = 5;
  std::uint32_t id = 0;
  if (bytes.size() < kHeadBytes || bytes[0] != kMessageData)
    return refused("expected the data of a message");
  std::memcpy(&id, bytes.data() + 1, sizeof id);
  const auto known = published_.find(id);
  if (known == published_.end()) return refused(fmt::format("channel {}: was not advertised", id));
  const auto& [topic, encoding] = known->second;
  if (topic != kCommandTopic) return {};  // nobody listens
  try {
    const ros::Twist twist = twist_of(bytes.substr(kHeadBytes), encoding);
    for (const double value : {twist.linear.x, twist.linear.y, twist.angular.z})
      if (!std::isfinite(value)) return refused(fmt::format("{}: is not finite", topic));
    return {.command =
                Ordered{{"drive", {twist.linear.x, twist.linear.y, twist.angular.z}}}.dump()};
  } catch (const InputError& error) {
    return refused(fmt::format("{}: {}", topic, error.what()));
  }
}

std::optional<std::string> FoxgloveClient::head(std::size_t topic, Stamp stamp_ns) const {
  const auto found = subscription_of_.find(topic);
  if (found == subscription_of_.end()) return std::nullopt;
  std::string head(1, kMessageData);
  append(head, found->second);
  append(head, static_cast<std::uint64_t>(stamp_ns));
  return head;
}

}  // namespace mh
