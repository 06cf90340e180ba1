#pragma once
/// A table of the open connections.
#include <chrono>
#include <map>
#include <mutex>

namespace voxdag {

/// Thread-safe. A socket is in the table while it is open, so that no other file has its number.
class Connections {
 public:
  /// Adds a connection, which waits for its first request.
  void add(int socket);
  /// Says whether the connection waits for its next request.
  void set_waiting(int socket, bool is_waiting);
  /// Closes the socket.
  void close(int socket);

  /// Ends the connection that has waited longest for its next request. Returns false if none waits.
  bool end_longest_waiting();
  /// Ends all connections, and until begin_again() also those that are added.
  void end_all();
  void begin_again();

 private:
  struct State {
    bool is_waiting = true, is_ended = false;
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
  };

  std::mutex mutex_;
  std::map<int, State> states_;
  bool are_ended_ = false;
};

}  // namespace voxdag
