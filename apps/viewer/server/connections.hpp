#pragma once
/// The open connections: which of them wait for a request, and how to end them all.
#include <chrono>
#include <map>
#include <mutex>

namespace voxdag {

/// Thread-safe. A socket is in the table while it is open, so that no other file has its number.
class Connections {
 public:
  void add(int socket);
  void set_waiting(int socket, bool is_waiting);
  /// Closes the socket.
  void close(int socket);

  /// Ends the connection that has waited longest for its next request. Returns false if none waits.
  bool end_longest_waiting();
  /// Ends all connections, and those that are added later, until begin_again().
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
