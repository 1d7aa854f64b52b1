// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/live/live_page.hpp"
#include "scenes/recordings/messages/message_log.hpp"

namespace mh {

/// Where a LiveServer listens, and which clients it admits.
struct LiveAddress {
  std::string host = "127.0.0.1";
  int port = 0;            ///< 0: any free port
  std::string token = {};  ///< required of every client (`?token=`); if empty, only programs on
                           ///< this machine are admitted
};

/// What a LiveServer shows. The functions are called on another thread.
struct LiveShow {
  std::filesystem::path page;             ///< folder of index.html, live.js and live.css
  std::function<std::string()> greeting;  ///< the first message to each viewer of the page
  /// Receives a command (docs/live.md). @returns why it was not understood; empty if it was
  std::function<std::string(const std::string&)> take;
  std::vector<TopicSpec> topics = {};  ///< for clients of Foxglove's protocol
};

/// Serves a page and its WebSocket, and Foxglove's protocol, on one port (with Boost.Beast, which
/// limits how much it reads). Requests under a foreign host name or with a foreign Origin are
/// refused, so that no other web page can reach the server; with a token, a page that knows it may
/// open a WebSocket. Requests, messages and connections are bounded, and a client that reads too
/// slowly misses images and messages.
class LiveServer {
 public:
  /// @throws InputError if the address cannot be used
  LiveServer(const LiveAddress& address, LiveShow show);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// The address to open in a browser.
  std::string url() const;
  int port() const;
  void send_text(std::string text);    ///< to every viewer of the page
  void send_image(std::string bytes);  ///< to every viewer of the page except those that lag behind
  void send_images(const PageImages& images);  ///< the same for the images of a frame
  /// To the clients of Foxglove's protocol that subscribed, except those that lag behind. The last
  /// message of a latched topic is kept for later subscribers.
  void send_messages(std::vector<MessageLog::Entry> messages);
  int viewers() const;        ///< of the page
  int subscriptions() const;  ///< of all clients of Foxglove's protocol

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mh
