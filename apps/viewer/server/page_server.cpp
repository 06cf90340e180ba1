#include "viewer/server/page_server.hpp"

#include <fcntl.h>
#include <httplib.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <exception>
#include <optional>
#include <system_error>
#include <thread>

#include "viewer/server/answers.hpp"
#include "viewer/server/client_stream.hpp"
#include "viewer/server/connection_threads.hpp"
#include "viewer/server/connections.hpp"
#include "viewer/server/request_head.hpp"
#include "viewer/server/server_address.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/descriptor.hpp"

namespace voxdag {

class PageServer::Http final : public httplib::Server {
 public:
  Http(const SceneBytes& scene, const ServerOptions& options) : options_(options) {
    new_task_queue = [this] {
      return new ConnectionThreads(connections_, options_.limits.most_connections);
    };
    set_default_headers(Answers::default_headers());
    set_keep_alive_timeout(std::chrono::ceil<std::chrono::seconds>(options_.limits.idle).count());
    set_keep_alive_max_count(kMaxRequests);
    // The library would also set SO_REUSEPORT; without it, a port that is in use is an error.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      answers_->answer(request, response);
      return HandlerResponse::Handled;  // Nothing reaches the library's own routes.
    });
    set_post_routing_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.status == 304) response.headers.erase("Content-Length");
    });
    bind();
    if (options_.editing != nullptr && !is_local_)
      throw Error("cannot edit on " + options_.address +
                  ": other machines could edit, too; only an address of this machine can be used");
    answers_.emplace(scene, options_.files, is_local_ ? url_host(options_.address) : "");
    if (options_.editing != nullptr) {
      token_ = make_token();
      answers_->take_edits(*options_.editing, token_);
    }
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
    shutdown(listener_.get(), SHUT_RDWR);  // Every later accept() fails.
    thread_.join();
  }
  int port() const { return port_; }
  const std::string& address() const { return options_.address; }
  const std::string& token() const { return token_; }

 private:
  static constexpr int kMaxRequests = 1000;  // The largest number of requests of a connection.

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

  /// Answers requests until the connection ends. If memory runs out, ends this connection only.
  void serve_all(ClientStream& client) try {
    for (int requests = 1; serve_one(client, requests == kMaxRequests); ++requests) {
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
    const RequestHead head =
        check_head(client.head(), options_.limits, options_.editing != nullptr);
    if (head.refusal != 0) {
      client.send_status(head.refusal);
      return false;
    }
    std::optional<std::string> body = client.receive_body(head.body_bytes);
    if (!body) {
      client.send_status(408);
      return false;
    }
    client.begin_response();
    bool is_closed = is_last || head.may_have_body;
    const bool is_sent =
        process_request(client, is_closed, is_closed, [&](httplib::Request& request) {
          request.body = std::move(*body);
          answers_->plan(request);
        });
    return is_sent && !is_closed;
  }

  const ServerOptions options_;
  std::optional<Answers> answers_;  // Made when the address is known.
  std::string token_;               // Of the page that edits.
  Connections connections_;
  Descriptor listener_;  // A duplicate of the listening socket; the library owns svr_sock_.
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
  const std::string& token = http_->token();
  return "http://" + url_host(http_->address()) + ":" + std::to_string(port()) + "/" +
         (token.empty() ? "" : "?edit=" + token);
}

}  // namespace voxdag
