// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace mh {

/// Where a LiveServer listens, and whom it lets in.
struct LiveAddress {
  std::string host = "127.0.0.1";
  int port = 0;            ///< 0: any that is free
  std::string token = {};  ///< required of every client (`?token=`); empty: only programs on this
                           ///< machine are let in
};

/// Serves a page and a WebSocket on one port (Boost.Beast, which bounds what it reads). Requests
/// under a foreign host name or with a foreign Origin are refused, so that no other web page
/// reaches it; requests, messages and connections are bounded, and a viewer that reads too slowly
/// misses images.
class LiveServer {
 public:
  /// @param page      folder of index.html, live.js and live.css
  /// @param greeting  the first message to each viewer
  /// @param heard     receives each viewer's message and returns the answer; "" if there is none
  /// Both functions are called on another thread.
  /// @throws InputError if the address cannot be used
  LiveServer(const LiveAddress& address, const std::filesystem::path& page,
             std::function<std::string()> greeting,
             std::function<std::string(const std::string&)> heard);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// The address that a browser opens.
  std::string url() const;
  int port() const;
  void send_text(std::string text);    ///< to every viewer
  void send_image(std::string bytes);  ///< the same; dropped for viewers that lag behind
  int viewers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mh
