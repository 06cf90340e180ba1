#include "viewer/server/page_server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <httplib.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <map>
#include <span>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "viewer/embedded/page_files.hpp"
#include "viewer/server/client_stream.hpp"
#include "viewer/server/connection_threads.hpp"
#include "viewer/server/connections.hpp"
#include "viewer/server/multipart_body.hpp"
#include "viewer/server/scene_ranges.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/io/checksum.hpp"
#include "voxdag/io/descriptor.hpp"

namespace voxdag {
namespace {

constexpr char kScenePath[] = "/scene.vdag";
constexpr char kSceneType[] = "application/octet-stream";

/// Nothing but the files of this server, and for each kind only what the page needs: modules;
/// a worker and pictures that the page makes itself (blob:), and pictures in its style sheet
/// (data:). No inline scripts or styles. No frames of other sites around the page.
constexpr char kContentSecurityPolicy[] =
    "default-src 'none'; script-src 'self'; worker-src blob:; connect-src 'self'; "
    "style-src 'self'; img-src 'self' data: blob:; font-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'self'";

const httplib::Headers kDefaultHeaders = {
    {"Content-Security-Policy", kContentSecurityPolicy},
    // Types are as the server says; a file is never taken for a script.
    {"X-Content-Type-Options", "nosniff"},
    // Other sites can neither embed the scene nor get a handle of the page's window.
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    // Browsers keep copies, but ask each time whether they are still right.
    {"Cache-Control", "no-cache"}};

std::string quoted_tag(std::string_view tag) {
  std::string text = "\"";
  text.append(tag).append("\"");
  return text;
}

std::string tag_of(std::string_view bytes) {
  return quoted_tag(fmt::format("{:016x}", xxh3_64(std::as_bytes(std::span(bytes)))));
}

/// Returns the host of a Host field, without its port: "[::1]" for "[::1]:80".
std::string host_of(const std::string& field) {
  const std::size_t bracket = field.find(']');
  const std::size_t colon = field.find(':', bracket == field.npos ? 0 : bracket);
  return field.substr(0, colon);
}

bool is_loopback(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET6)
    return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
  const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(address);
  return address.ss_family == AF_INET && ntohl(ipv4.sin_addr.s_addr) >> 24 == 127;
}

int port_of(const sockaddr_storage& address) {
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

/// Returns the host for a URL; for an address that stands for all, the name of this machine.
std::string url_host(const std::string& address) {
  if (address == "0.0.0.0" || address == "::") {
    char name[256] = {};
    if (gethostname(name, sizeof name - 1) == 0 && name[0] != '\0') return name;
  }
  return address.find(':') == address.npos ? address : "[" + address + "]";
}

}  // namespace

class PageServer::Http final : public httplib::Server {
 public:
  Http(const SceneBytes& scene, const ServerOptions& options)
      : scene_(scene), options_(options), scene_tag_(quoted_tag(scene.tag())) {
    for (const PageFile& file : page_files()) page_tags_[file.path] = tag_of(file.bytes);
    new_task_queue = [this] {
      return new ConnectionThreads(connections_, options_.limits.most_connections);
    };
    set_default_headers(kDefaultHeaders);
    set_keep_alive_timeout(std::chrono::ceil<std::chrono::seconds>(options_.limits.idle).count());
    set_keep_alive_max_count(kMostRequests);
    // Without SO_REUSEPORT, which the library's default sets: a port that is in use is an error.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      answer(request, response);
      return HandlerResponse::Handled;  // Nothing reaches the library's own routes.
    });
    set_post_routing_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.status == 304) response.headers.erase("Content-Length");
    });
    bind();
  }
  ~Http() override {
    stop();
    if (svr_sock_ != INVALID_SOCKET) ::close(svr_sock_);
  }

  void start() {
    thread_ = std::thread([this] { serve(); });
  }
  void stop() {
    if (!thread_.joinable()) return;
    is_stopping_ = true;
    shutdown(listener_.get(), SHUT_RDWR);  // accept() fails, also when it has not begun.
    thread_.join();
  }
  int port() const { return port_; }
  const std::string& address() const { return options_.address; }

 private:
  static constexpr int kMostRequests = 1000;  // of a connection

  void bind() {
    errno = 0;
    const bool is_bound = options_.port == 0 ? bind_to_any_port(options_.address) > 0
                                             : bind_to_port(options_.address, options_.port);
    const int error = errno;
    sockaddr_storage bound{};
    socklen_t size = sizeof bound;
    if (!is_bound || getsockname(svr_sock_, reinterpret_cast<sockaddr*>(&bound), &size) != 0)
      throw Error("cannot listen on " + options_.address +
                  (options_.port == 0 ? "" : ", port " + std::to_string(options_.port)) + ": " +
                  (error == 0 ? "there is no such address on this machine"
                              : std::system_category().message(error)));
    // The library's queue of 5 is short: a page asks for many files at once.
    ::listen(svr_sock_, SOMAXCONN);
    listener_ = Descriptor(fcntl(svr_sock_, F_DUPFD_CLOEXEC, 0));
    if (!listener_.is_open())
      throw Error("cannot listen: " + std::system_category().message(errno));
    port_ = port_of(bound);
    is_local_ = is_loopback(bound);
  }

  /// Accepts connections until stop(). The library gives up, and closes its socket, at each error
  /// of accept() that it does not know, for example if the system has too many open files.
  void serve() {
    for (;;) {
      if (svr_sock_ != INVALID_SOCKET) listen_after_bind();
      svr_sock_ = INVALID_SOCKET;
      if (is_stopping_) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      svr_sock_ = fcntl(listener_.get(), F_DUPFD_CLOEXEC, 0);
      connections_.begin_again();
    }
  }

  bool process_and_close_socket(socket_t socket) override {
    const int yes = 1;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    connections_.add(socket);
    ClientStream client(socket, options_.limits, is_stopping_);
    if (ConnectionThreads::is_refused())
      client.send_status(503);
    else
      serve_all(client);
    connections_.close(socket);
    return true;
  }

  /// Answers requests until the connection ends. Without memory only this connection ends.
  void serve_all(ClientStream& client) try {
    for (int requests = 1; serve_one(client, requests == kMostRequests); ++requests) {
    }
  } catch (const std::exception&) {
  }

  /// Answers the next request. Returns whether the connection stays open.
  bool serve_one(ClientStream& client, bool is_last) {
    connections_.set_waiting(client.socket(), true);
    const HeadResult result = client.receive_head();
    connections_.set_waiting(client.socket(), false);
    if (result == HeadResult::kClosed) return false;
    if (result != HeadResult::kComplete) {
      client.send_status(result == HeadResult::kTooSlow ? 408 : 431);
      return false;
    }
    const RequestHead head = check_head(client.head(), options_.limits);
    if (head.refusal != 0) {
      client.send_status(head.refusal);
      return false;
    }
    client.begin_response();
    bool is_closed = is_last || head.may_have_body;
    const bool is_sent = process_request(client, is_closed, is_closed,
                                         [this](httplib::Request& request) { plan(request); });
    return is_sent && !is_closed;
  }

  static bool is_for_scene(const httplib::Request& request) { return request.path == kScenePath; }

  /// The ranges of the request that this thread answers.
  struct PlannedRanges {
    bool are_wrong = false;         // Nothing can satisfy them.
    std::vector<ByteRange> ranges;  // Of resolve_ranges(); none: the whole scene.
  };
  static PlannedRanges& planned() {
    static thread_local PlannedRanges ranges;
    return ranges;
  }

  /// Takes the ranges out of the request, so that the library applies none itself. Drops them if
  /// they do not apply.
  void plan(httplib::Request& request) const {
    planned() = {};
    std::vector<ByteRange> ranges;
    std::swap(ranges, request.ranges);
    const std::string if_range = request.get_header_value("If-Range");
    if (ranges.empty() || request.method != "GET" || !is_for_scene(request) ||
        (!if_range.empty() && if_range != scene_tag_))
      return;
    planned().are_wrong = !resolve_ranges(ranges, scene_.size());
    planned().ranges = std::move(ranges);
  }

  bool is_allowed_host(const httplib::Request& request) const {
    if (!is_local_) return true;
    const std::string host = host_of(request.get_header_value("Host"));
    return host == "localhost" || host == "127.0.0.1" || host == "[::1]" ||
           host == url_host(options_.address);
  }

  void answer(const httplib::Request& request, httplib::Response& response) const {
    if (!is_allowed_host(request))
      return refuse(response, 403, "this server answers only for localhost");
    if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      return refuse(response, 405, "only GET and HEAD");
    }
    if (is_for_scene(request)) return answer_scene(request, response);
    const std::string_view path = request.path;
    const PageFile* const file = path == "/"             ? find_page_file("index.html")
                                 : path.starts_with("/") ? find_page_file(path.substr(1))
                                                         : nullptr;
    if (file == nullptr) return refuse(response, 404, "not found");
    if (answer_known(request, response, page_tags_.at(file->path))) return;
    give(response, file->bytes.size(), std::string(file->type),
         [file](std::uint64_t offset, auto out) {
           std::copy_n(
               std::as_bytes(std::span(file->bytes)).begin() + static_cast<std::ptrdiff_t>(offset),
               out.size(), out.begin());
           return true;
         });
  }

  void answer_scene(const httplib::Request& request, httplib::Response& response) const {
    if (!scene_.is_unchanged())
      return refuse(response, 500,
                    "the scene's file has changed since the server opened it: start it again");
    response.set_header("Accept-Ranges", "bytes");
    if (answer_known(request, response, scene_tag_)) return;
    if (planned().are_wrong) {
      response.set_header("Content-Range", fmt::format("bytes */{}", scene_.size()));
      response.status = 416;
      return;
    }
    const std::vector<ByteRange>& ranges = planned().ranges;
    if (!ranges.empty()) response.status = 206;
    if (ranges.size() > 1) return answer_parts(ranges, response);
    std::uint64_t begin = 0, size = scene_.size();
    if (!ranges.empty()) {
      const auto [first, last] = ranges[0];
      response.set_header("Content-Range",
                          fmt::format("bytes {}-{}/{}", first, last, scene_.size()));
      begin = static_cast<std::uint64_t>(first);
      size = static_cast<std::uint64_t>(last - first) + 1;
    }
    give(response, size, kSceneType, [this, begin](std::uint64_t offset, auto out) {
      return scene_.read(begin + offset, out);
    });
  }

  void answer_parts(const std::vector<ByteRange>& ranges, httplib::Response& response) const {
    const std::string boundary = "voxdag-range-" + scene_.tag();
    const auto body = std::make_shared<MultipartBody>(scene_, ranges, kSceneType, boundary);
    give(response, body->size(), "multipart/byteranges; boundary=" + boundary,
         [body](std::uint64_t offset, auto out) { return body->read(offset, out); });
  }

  /// Sets the entity tag. Returns true, and the status 304, if the client has these bytes already.
  static bool answer_known(const httplib::Request& request, httplib::Response& response,
                           const std::string& tag) {
    response.set_header("ETag", tag);
    if (!has_tag(request.get_header_value("If-None-Match"), tag)) return false;
    response.status = 304;
    return true;
  }

  static void refuse(httplib::Response& response, int status, const std::string& text) {
    response.status = status;
    response.set_content(text + "\n", "text/plain; charset=utf-8");
  }

  /// Sends `size` bytes, which `read` gives piece by piece.
  template <class Read>
  static void give(httplib::Response& response, std::uint64_t size, const std::string& type,
                   const Read& read) {
    if (size == 0) return response.set_content("", type);
    response.set_content_provider(
        size, type, [read](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
          constexpr std::size_t kPiece = 65536;
          std::vector<std::byte> piece(std::min(length, kPiece));
          return read(offset, std::span<std::byte>(piece)) &&
                 sink.write(reinterpret_cast<const char*>(piece.data()), piece.size());
        });
  }

  const SceneBytes& scene_;
  const ServerOptions options_;
  const std::string scene_tag_;
  std::map<std::string_view, std::string> page_tags_;
  Connections connections_;
  Descriptor listener_;  // The listening socket again: svr_sock_ belongs to the library.
  std::thread thread_;
  std::atomic<bool> is_stopping_ = false;
  int port_ = 0;
  bool is_local_ = false;
};

PageServer::PageServer(const SceneBytes& scene, const ServerOptions& options)
    : http_(std::make_unique<Http>(scene, options)) {}

PageServer::~PageServer() = default;

void PageServer::start() { http_->start(); }

void PageServer::stop() { http_->stop(); }

int PageServer::port() const { return http_->port(); }

std::string PageServer::url() const {
  return "http://" + url_host(http_->address()) + ":" + std::to_string(port()) + "/";
}

}  // namespace voxdag
