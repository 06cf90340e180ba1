#pragma once
/// The HTTP server of `voxdag view`: the page and one scene.
#include <chrono>
#include <memory>
#include <string>

#include "viewer/scene/scene_bytes.hpp"

namespace voxdag {

/// Bounds on what clients may cost. A client that exceeds one loses its connection.
struct ServerLimits {
  int most_connections = 128;
  std::size_t most_head_bytes = 16384;      ///< Of a request: its first line and its header fields.
  int most_fields = 100;                    ///< Header fields of a request.
  std::size_t most_range_bytes = 512;       ///< Of the field Range.
  int most_ranges = 16;                     ///< In the field Range.
  std::chrono::milliseconds head{10'000};   ///< From the first byte of a request to its last.
  std::chrono::milliseconds idle{30'000};   ///< Until the first byte of the next request.
  std::chrono::milliseconds stall{15'000};  ///< Without progress of a response.
  /// A response must have `least_rate` bytes per second on average once it has taken `grace`.
  std::chrono::milliseconds grace{60'000};
  double least_rate = 1024;
};

struct ServerOptions {
  /// An address or a host name of this machine. On a loopback address the server answers only
  /// requests for a loopback host, so that no other site's name can lead a browser to it.
  std::string address = "127.0.0.1";
  int port = 0;  ///< 0: any free port.
  ServerLimits limits{};
};

/// Serves GET and HEAD of the page's files and of /scene.vdag, which is `scene`, with ranges and
/// entity tags. Everything else is 404 or 405. Each connection has a thread; one that waits for its
/// next request makes way if there are too many.
class PageServer {
 public:
  /// Listens; connections wait until start(). `scene` must outlive the server. Throws Error if the
  /// address cannot be used.
  PageServer(const SceneBytes& scene, const ServerOptions& options);
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;
  /// Stops.
  ~PageServer();

  /// Begins to answer, on threads of its own.
  void start();
  /// Ends all connections and threads. Does nothing if the server is not started.
  void stop();

  int port() const;
  /// Returns the address of the page: "http://127.0.0.1:8080/".
  std::string url() const;

 private:
  class Http;
  std::unique_ptr<Http> http_;
};

}  // namespace voxdag
