// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace mh {

/// Where a LiveServer listens, and which clients it admits.
struct LiveAddress {
  std::string host = "127.0.0.1";
  int port = 0;            ///< 0: any free port
  std::string token = {};  ///< required of every client (`?token=`); if empty, only programs on
                           ///< this machine are admitted
};

/// Serves a page and a WebSocket on one port (with Boost.Beast, which limits how much it reads).
/// Requests under a foreign host name or with a foreign Origin are refused, so that no other web
/// page can reach the server. Requests, messages and connections are bounded, and a viewer that
/// reads too slowly misses images.
class LiveServer {
 public:
  /// @param page      folder of index.html, live.js and live.css
  /// @param greeting  the first message to each viewer
  /// @param heard     receives each viewer's message and returns the answer; empty if there is none
  /// Both functions, `greeting` and `heard`, are called on another thread.
  /// @throws InputError if the address cannot be used
  LiveServer(const LiveAddress& address, const std::filesystem::path& page,
             std::function<std::string()> greeting,
             std::function<std::string(const std::string&)> heard);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// The address to open in a browser.
  std::string url() const;
  int port() const;
  void send_text(std::string text);    ///< to every viewer
  void send_image(std::string bytes);  ///< to every viewer except those that lag behind
  int viewers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mh
