#include "viewer/server/connection_threads.hpp"

#include <chrono>
#include <system_error>
#include <utility>

namespace voxdag {
namespace {

thread_local bool refuses = false;

}  // namespace

bool ConnectionThreads::is_refused() { return refuses; }

void ConnectionThreads::join_done() {
  for (auto worker = workers_.begin(); worker != workers_.end();) {
    if (!worker->is_done) {
      ++worker;
      continue;
    }
    worker->thread.join();
    worker = workers_.erase(worker);
  }
}

bool ConnectionThreads::make_way() {
  // Connections that are ending, or about to wait for their next request, need a moment.
  constexpr int kTries = 40;
  constexpr std::chrono::milliseconds kMoment{5};
  for (int i = 0; i < kTries; ++i) {
    if (i > 0) std::this_thread::sleep_for(kMoment);
    join_done();
    if (workers_.size() < most_) return true;
    // A connection that was ended may still be in the list.
    if (workers_.size() < 2 * most_ && connections_.end_longest_waiting()) return true;
  }
  return false;
}

void ConnectionThreads::enqueue(std::function<void()> serve) {
  if (make_way()) {
    Worker& worker = workers_.emplace_back();
    try {
      worker.thread = std::thread([serve, &worker] {
        serve();
        worker.is_done = true;
      });
      return;
    } catch (const std::system_error&) {  // The system has no more threads.
      workers_.pop_back();
    }
  }
  refuses = true;
  serve();
  refuses = false;
}

void ConnectionThreads::shutdown() {
  connections_.end_all();
  for (Worker& worker : workers_) worker.thread.join();
  workers_.clear();
}

}  // namespace voxdag
