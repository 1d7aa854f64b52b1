// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/recordings/messages/message_writer.hpp"

namespace mh {

/// What one client of Foxglove's WebSocket protocol, version 1
/// (github.com/foxglove/ws-protocol/blob/main/docs/spec.md), wants and publishes. It knows no
/// sockets: messages go in and come out as they are sent.
class FoxgloveClient {
 public:
  static constexpr std::string_view kSubprotocol = "foxglove.websocket.v1";

  /// @param topics  what can be subscribed to, in CDR; it must outlive this
  explicit FoxgloveClient(const std::vector<TopicSpec>& topics) : topics_(topics) {}

  /// The texts that greet the client: who the server is, and its topics.
  std::vector<std::string> greeting() const;

  /// What a message from the client leads to.
  struct Heard {
    std::vector<std::size_t> begun{};  ///< topics subscribed to by this message
    std::string command{};             ///< for LiveDrive::take(); empty: none
    std::string answer{};              ///< to be sent back, about an error; empty: none
  };
  Heard take_text(std::string_view text);
  /// Takes a message that the client publishes: geometry_msgs/Twist on `/cmd_vel`, in CDR or JSON.
  Heard take_binary(std::string_view bytes) const;

  std::size_t subscriptions() const { return subscription_of_.size(); }
  /// The bytes to send before a message of this topic; nullopt: the client does not want it.
  std::optional<std::string> head(std::size_t topic, Stamp stamp_ns) const;

 private:
  struct Published {
    std::string topic, encoding;
  };

  const std::vector<TopicSpec>& topics_;
  std::map<std::size_t, std::uint32_t> subscription_of_;  ///< the client's id, by topic
  std::map<std::uint32_t, Published> published_;          ///< by the client's id
};

/// The text that tells the clients about an error.
std::string foxglove_error(const std::string& why);

}  // namespace mh
