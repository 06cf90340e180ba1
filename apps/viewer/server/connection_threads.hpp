#pragma once
/// Runs each connection on a thread of its own, so that a slow client delays no other.
#include <httplib.h>

#include <atomic>
#include <functional>
#include <list>
#include <thread>

#include "viewer/server/connections.hpp"

namespace voxdag {

/// The HTTP library's queue of connections. If there are too many, it ends one that waits for its
/// next request. If none waits, it refuses the new one: it runs it at once, with is_refused().
class ConnectionThreads final : public httplib::TaskQueue {
 public:
  ConnectionThreads(Connections& connections, int most)
      : connections_(connections), most_(static_cast<std::size_t>(most)) {}

  void enqueue(std::function<void()> serve) override;
  /// Ends all connections and joins all threads.
  void shutdown() override;

  /// Returns whether the connection that the caller runs must be refused.
  static bool is_refused();

 private:
  struct Worker {
    std::atomic<bool> is_done = false;
    std::thread thread;
  };

  void join_done();
  /// Makes room for one more connection, if need be by ending one that waits. Returns false if
  /// there is none.
  bool make_way();

  Connections& connections_;
  std::size_t most_;
  std::list<Worker> workers_;
};

}  // namespace voxdag
