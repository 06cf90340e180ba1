#include "viewer/server/connections.hpp"

#include <sys/socket.h>
#include <unistd.h>

namespace voxdag {

void Connections::add(int socket) {
  const std::lock_guard lock(mutex_);
  states_.emplace(socket, State{});
  if (are_ended_) shutdown(socket, SHUT_RDWR);
}

void Connections::set_waiting(int socket, bool is_waiting) {
  const std::lock_guard lock(mutex_);
  State& state = states_.at(socket);
  state.is_waiting = is_waiting;
  state.since = std::chrono::steady_clock::now();
}

void Connections::close(int socket) {
  const std::lock_guard lock(mutex_);
  states_.erase(socket);
  shutdown(socket, SHUT_RDWR);
  ::close(socket);
}

bool Connections::end_longest_waiting() {
  const std::lock_guard lock(mutex_);
  auto longest = states_.end();
  for (auto at = states_.begin(); at != states_.end(); ++at)
    if (at->second.is_waiting && !at->second.is_ended &&
        (longest == states_.end() || at->second.since < longest->second.since))
      longest = at;
  if (longest == states_.end()) return false;
  longest->second.is_ended = true;
  shutdown(longest->first, SHUT_RDWR);
  return true;
}

void Connections::begin_again() {
  const std::lock_guard lock(mutex_);
  are_ended_ = false;
}

void Connections::end_all() {
  const std::lock_guard lock(mutex_);
  are_ended_ = true;
  for (const auto& [socket, state] : states_) shutdown(socket, SHUT_RDWR);
}

}  // namespace voxdag
