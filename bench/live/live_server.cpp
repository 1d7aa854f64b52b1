// SPDX-License-Identifier: Apache-2.0
#include "bench/live/live_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "bench/live/foxglove.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using Error = beast::error_code;

constexpr std::size_t kMostConnections = 256, kMostViewers = 32, kMostQueuedBytes = 1U << 20U,
                      kMostQueuedOfFoxglove = 16U << 20U, kMostMessageBytes = 4096,
                      kMostFoxgloveBytes = 65536, kMostHeaderBytes = 8192;
constexpr auto kRequestTime = std::chrono::seconds(5);

struct PageFile {
  const char *target, *file, *type;
};
constexpr std::array<PageFile, 3> kPage = {{{"/", "index.html", "text/html; charset=utf-8"},
                                            {"/live.js", "live.js", "text/javascript"},
                                            {"/live.css", "live.css", "text/css"}}};

/// Compares two texts in a time that does not reveal how much of a guess is right.
bool is_same(std::string_view a, std::string_view b) {
  unsigned differs = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    differs |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return differs == 0;
}

using SharedBytes = std::shared_ptr<const std::string>;

SharedBytes shared(std::string bytes) {
  return std::make_shared<const std::string>(std::move(bytes));
}

struct Outgoing {
  SharedBytes content;
  std::string head = {};  ///< sent before the content
  bool is_binary = false;
  bool may_be_missed = false;  ///< by a client that lags behind
};

/// The value of a key in a target's query; empty if the query lacks the key.
std::string query_value(const std::string& target, const std::string& key) {
  for (auto at = target.find('?'); at != std::string::npos; at = target.find('&', at + 1)) {
    const std::string part = target.substr(at + 1, target.find('&', at + 1) - at - 1);
    if (part.starts_with(key + "=")) return part.substr(key.size() + 1);
  }
  return "";
}

std::string text_of(beast::string_view view) {
  return {view.data(), view.size()};
}

}  // namespace

struct LiveServer::Impl {
  class Viewer;

  std::size_t connections = 0;  // declared before members that may hold connections
  asio::io_context io{1};
  Tcp::acceptor acceptor{io};
  LiveAddress address;
  LiveShow show;
  // Used only on the server's thread.
  std::set<std::shared_ptr<Viewer>> joined;
  std::map<std::size_t, std::pair<Stamp, SharedBytes>> latched;  ///< last messages, by topic

  std::atomic<int> viewers{0}, subscriptions{0};
  std::thread thread;

  void accept();
  void send(const Outgoing& message);
  void send(std::vector<MessageLog::Entry> messages);
  void count();
  /// The reason for refusing a request; empty if it is not refused.
  std::string refusal(const http::request<http::string_body>& request) const;
};

/// One connection: a request for a part of the page, or a WebSocket, of the page or of a client of
/// Foxglove's protocol.
class LiveServer::Impl::Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(Impl& server, Tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    ++server_.connections;
    parser_.header_limit(kMostHeaderBytes);
    parser_.body_limit(0);
  }
  ~Viewer() { --server_.connections; }

  void start() {
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](Error error, std::size_t) {
                       if (!error) self->answer();
                     });
  }
  const std::optional<FoxgloveClient>& foxglove() const { return foxglove_; }
  void queue(Outgoing message) {
    const std::size_t most = foxglove_ ? kMostQueuedOfFoxglove : kMostQueuedBytes;
    if (queued_bytes_ > most) {
      if (message.may_be_missed) return;
      if (queued_bytes_ > 4 * most) return leave();
    }
    queued_bytes_ += message.head.size() + message.content->size();
    queue_.push_back(std::move(message));
    if (queue_.size() == 1) write();
  }

 private:
  void answer() {
    const auto& request = parser_.get();
    if (const std::string why = server_.refusal(request); !why.empty())
      return reply(http::status::forbidden, "text/plain", why + "\n");
    std::string target = text_of(request.target());
    target = target.substr(0, target.find('?'));
    const bool upgrades = websocket::is_upgrade(request);
    if (upgrades) {
      const auto asked = request[http::field::sec_websocket_protocol];
      for (const auto& protocol : http::token_list(asked))
        if (text_of(protocol) == FoxgloveClient::kSubprotocol && target == "/")
          foxglove_.emplace(server_.show.topics);
    }
    if (foxglove_ || (upgrades && target == "/ws")) {
      if (server_.joined.size() < kMostViewers) return upgrade();
      return reply(http::status::service_unavailable, "text/plain", "there are too many viewers\n");
    }
    if (request.method() == http::verb::get)
      for (const PageFile& file : kPage)
        if (target == file.target)
          return reply(http::status::ok, file.type, read_file(server_.show.page / file.file));
    reply(http::status::not_found, "text/plain", "nothing found here\n");
  }

  void reply(http::status status, const char* type, std::string body) {
    response_ = {status, 11};
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Content-Security-Policy",
                  "default-src 'self'; img-src 'self' blob: data:; connect-src 'self' ws:");
    response_.keep_alive(false);
    response_.body() = std::move(body);
    response_.prepare_payload();
    http::async_write(stream_, response_, [self = shared_from_this()](Error, std::size_t) {
      Error no_matter;
      self->stream_.socket().shutdown(Tcp::socket::shutdown_send, no_matter);
    });
  }

  void upgrade() {
    stream_.expires_never();
    socket_ = std::make_unique<websocket::stream<beast::tcp_stream>>(std::move(stream_));
    socket_->set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_->read_message_max(foxglove_ ? kMostFoxgloveBytes : kMostMessageBytes);
    if (foxglove_)
      socket_->set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
        response.set(http::field::sec_websocket_protocol,
                     std::string(FoxgloveClient::kSubprotocol));
      }));
    socket_->async_accept(parser_.get(), [self = shared_from_this()](Error error) {
      if (error) return;
      self->server_.joined.insert(self);
      self->server_.count();
      for (std::string& text : self->foxglove_ ? self->foxglove_->greeting()
                                               : std::vector{self->server_.show.greeting()})
        self->queue({shared(std::move(text))});
      self->buffer_.clear();
      self->read();
    });
  }

  void take(const std::string& message) {
    if (foxglove_) return take_of_foxglove(message);
    if (!socket_->got_text()) return;
    if (const std::string why = server_.show.take(message); !why.empty())
      queue({shared(nlohmann::json{{"error", why}}.dump())});
  }

  void take_of_foxglove(const std::string& message) {
    FoxgloveClient::Heard heard =
        socket_->got_text() ? foxglove_->take_text(message) : foxglove_->take_binary(message);
    server_.count();
    if (!heard.command.empty())
      if (const std::string why = server_.show.take(heard.command); !why.empty())
        heard.answer = foxglove_error(why);
    if (!heard.answer.empty()) queue({shared(std::move(heard.answer))});
    for (const std::size_t topic : heard.begun)
      if (const auto last = server_.latched.find(topic); last != server_.latched.end()) {
        const auto& [stamp_ns, bytes] = last->second;
        queue({bytes, *foxglove_->head(topic, stamp_ns), true});
      }
  }

  void read() {
    socket_->async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) {
      if (error) return self->leave();
      self->take(beast::buffers_to_string(self->buffer_.data()));
      self->buffer_.consume(self->buffer_.size());
      self->read();
    });
  }

  void write() {
    const Outgoing& first = queue_.front();
    socket_->binary(first.is_binary);
    socket_->async_write(std::array{asio::buffer(first.head), asio::buffer(*first.content)},
                         [self = shared_from_this()](Error error, std::size_t) {
                           if (error) return self->leave();
                           self->queued_bytes_ -= self->queue_.front().head.size() +
                                                  self->queue_.front().content->size();
                           self->queue_.pop_front();
                           if (!self->queue_.empty()) self->write();
                         });
  }

  void leave() {
    server_.joined.erase(shared_from_this());
    server_.count();
    Error no_matter;
    beast::get_lowest_layer(*socket_).socket().close(no_matter);
  }

  Impl& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kMostHeaderBytes + kMostFoxgloveBytes};
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
  std::unique_ptr<websocket::stream<beast::tcp_stream>> socket_;
  std::optional<FoxgloveClient> foxglove_;  // nullopt: the page
  std::deque<Outgoing> queue_;              // the first message is being written
  std::size_t queued_bytes_ = 0;
};

void LiveServer::Impl::accept() {
  acceptor.async_accept([this](Error error, Tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error && connections < kMostConnections)
      std::make_shared<Viewer>(*this, std::move(socket))->start();
    accept();
  });
}

void LiveServer::Impl::send(const Outgoing& message) {
  for (const auto& viewer : std::vector(joined.begin(), joined.end()))
    if (!viewer->foxglove()) viewer->queue(message);
}

void LiveServer::Impl::send(std::vector<MessageLog::Entry> messages) {
  for (MessageLog::Entry& message : messages) {
    const SharedBytes bytes = shared(std::move(message.message));
    const bool is_latched = show.topics[message.topic].latched;
    if (is_latched) latched[message.topic] = {message.stamp_ns, bytes};
    for (const auto& viewer : std::vector(joined.begin(), joined.end()))
      if (viewer->foxglove())
        if (auto head = viewer->foxglove()->head(message.topic, message.stamp_ns))
          viewer->queue({bytes, *std::move(head), true, !is_latched});
  }
}

void LiveServer::Impl::count() {
  std::size_t of_foxglove = 0, wanted = 0;
  for (const auto& viewer : joined)
    if (viewer->foxglove()) {
      ++of_foxglove;
      wanted += viewer->foxglove()->subscriptions();
    }
  viewers = static_cast<int>(joined.size() - of_foxglove);
  subscriptions = static_cast<int>(wanted);
}

std::string LiveServer::Impl::refusal(const http::request<http::string_body>& request) const {
  const std::string host = text_of(request[http::field::host]);
  const int port = acceptor.local_endpoint().port();
  if (address.token.empty()) {
    // Otherwise, the owner of a foreign host name that resolves to this machine could give their
    // own page access (DNS rebinding).
    const bool is_ours = host == fmt::format("127.0.0.1:{}", port) ||
                         host == fmt::format("localhost:{}", port) ||
                         host == fmt::format("[::1]:{}", port);
    if (!is_ours) return "this is for the machine's own programs";
  } else {
    const std::string target = text_of(request.target());
    const bool is_part = target == "/live.js" || target == "/live.css";  // reveal nothing
    if (!is_part && !is_same(query_value(target, "token"), address.token))
      return "the token is missing or wrong";
  }
  // Foxglove's own page has a foreign origin: a token vouches for it.
  const std::string origin = text_of(request[http::field::origin]);
  const bool is_vouched_for = !address.token.empty() && websocket::is_upgrade(request);
  if (!origin.empty() && origin != "http://" + host && !is_vouched_for)
    return "pages from other sites may not open this";
  return "";
}

LiveServer::LiveServer(const LiveAddress& address, LiveShow show)
    : impl_(std::make_unique<Impl>()) {
  impl_->address = address;
  impl_->show = std::move(show);
  Error error;
  const auto host = asio::ip::make_address(address.host, error);
  if (error) throw InputError(fmt::format("host '{}': is not an address", address.host));
  if (address.token.empty() && !host.is_loopback())
    throw InputError(fmt::format("host {}: viewers on other machines need a token", address.host));
  if (!std::ranges::all_of(address.token, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '-' || c == '_';
      }))
    throw InputError("token: only letters, digits, '-' and '_'");
  const Tcp::endpoint endpoint(host, static_cast<unsigned short>(address.port));
  impl_->acceptor.open(endpoint.protocol(), error);
  if (!error) impl_->acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) impl_->acceptor.bind(endpoint, error);
  if (!error) impl_->acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw InputError(fmt::format("{} port {}: {}", address.host, address.port, error.message()));
  impl_->accept();
  impl_->thread = std::thread([this] { impl_->io.run(); });
}

LiveServer::~LiveServer() {
  impl_->io.stop();
  impl_->thread.join();
  impl_->joined.clear();
}

std::string LiveServer::url() const {
  const std::string& token = impl_->address.token;
  const auto host = asio::ip::make_address(impl_->address.host);
  const std::string name = host.is_unspecified() ? asio::ip::host_name()
                           : host.is_v6()        ? "[" + impl_->address.host + "]"
                                                 : impl_->address.host;
  return fmt::format("http://{}:{}/{}", name, port(), token.empty() ? "" : "?token=" + token);
}
int LiveServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}
void LiveServer::send_text(std::string text) {
  asio::post(impl_->io, [impl = impl_.get(), bytes = shared(std::move(text))] {
    impl->send(Outgoing{bytes});
  });
}
void LiveServer::send_image(std::string bytes) {
  asio::post(impl_->io, [impl = impl_.get(), bytes = shared(std::move(bytes))] {
    impl->send(Outgoing{.content = bytes, .is_binary = true, .may_be_missed = true});
  });
}
void LiveServer::send_images(const PageImages& images) {
  char kind = 0;
  for (const std::string* image : {&images.color, &images.depth, &images.labels})
    send_image(std::string(1, kind++) + *image);
}
void LiveServer::send_messages(std::vector<MessageLog::Entry> messages) {
  asio::post(impl_->io, [impl = impl_.get(), messages = std::move(messages)]() mutable {
    impl->send(std::move(messages));
  });
}
int LiveServer::viewers() const {
  return impl_->viewers;
}
int LiveServer::subscriptions() const {
  return impl_->subscriptions;
}

}  // namespace mh
