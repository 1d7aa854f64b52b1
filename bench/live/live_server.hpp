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
  std::string token = {};  ///< asked of everybody (`?token=`); empty: only programs of this machine
                           ///< are let in
};

/// Serves a page and a WebSocket on one port (Boost.Beast: it bounds what it reads). Whoever opens
/// it must be meant: requests under a foreign name or with a foreign Origin are refused, so that no
/// web page reaches it; requests, messages and connections are bounded, and a viewer that reads too
/// slowly misses images.
class LiveServer {
 public:
  /// @param page      folder of index.html, live.js and live.css
  /// @param greeting  the first message to each viewer
  /// @param heard     receives each message of a viewer and returns the answer to him, "" for none
  /// Both are called on another thread.
  /// @throws InputError if the address cannot be used
  LiveServer(const LiveAddress& address, const std::filesystem::path& page,
             std::function<std::string()> greeting,
             std::function<std::string(const std::string&)> heard);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// Where a browser opens it.
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
