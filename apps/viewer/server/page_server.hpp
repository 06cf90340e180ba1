#pragma once
/// The HTTP server of `voxdag view`: the page and one scene.
#include <memory>
#include <string>

#include "viewer/edit/edit_session.hpp"
#include "viewer/embedded/page_files.hpp"
#include "viewer/scene/scene_bytes.hpp"
#include "viewer/server/server_limits.hpp"

namespace voxdag {

struct ServerOptions {
  /// An address or a host name of this machine. On a loopback address the server refuses requests
  /// whose Host is not a loopback host: a site cannot reach it under a name of its own.
  std::string address = "127.0.0.1";
  int port = 0;  ///< 0: any free port.
  ServerLimits limits{};
  /// The files of the page, which must outlive the server.
  std::span<const PageFile> files = page_files();
  /// The scene to edit, which must outlive the server; null: the page only shows it.
  EditSession* editing = nullptr;
};

/// Answers requests as Answers does. Each connection has a thread. If there are too many, one that
/// waits for its next request is closed.
class PageServer {
 public:
  /// Listens; connections wait until start(). `scene` must outlive the server. Throws Error if the
  /// address cannot be used, and for editing on an address that other machines can reach.
  PageServer(const SceneBytes& scene, const ServerOptions& options);
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;
  /// Calls stop().
  ~PageServer();

  /// Starts to answer on its own threads.
  void start();
  /// Ends all connections and threads. Does nothing if the server is not started.
  void stop();

  int port() const;
  /// Returns the address of the page: "http://127.0.0.1:8080/". Who knows the address of a page
  /// that edits may edit: it ends in "?edit=" and a secret.
  std::string url() const;

 private:
  class Http;
  std::unique_ptr<Http> http_;
};

}  // namespace voxdag
