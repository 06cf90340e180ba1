#pragma once
/// A client's connection, limited in time and size. The HTTP library reads and writes through it.
#include <httplib.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "viewer/server/server_limits.hpp"

namespace voxdag {

/// How the wait for the head of a request ended.
enum class HeadResult {
  kComplete,
  kClosed,   ///< The client left or sent nothing in time, or the server stops.
  kTooSlow,  ///< Only a part of the head came in time.
  kTooLarge,
};

class ClientStream final : public httplib::Stream {
 public:
  /// The caller keeps the socket open. All calls fail soon after `is_stopping` becomes true.
  ClientStream(int socket, const ServerLimits& limits, const std::atomic<bool>& is_stopping)
      : socket_(socket), limits_(limits), is_stopping_(is_stopping) {}

  /// Waits for the next head; read() then returns its bytes.
  HeadResult receive_head();
  std::string_view head() const { return std::string_view(received_).substr(0, head_bytes_); }
  /// Waits for the `size` bytes behind the head, and returns them; nothing if they do not come in
  /// time.
  std::optional<std::string> receive_body(std::size_t size);
  /// Starts the time limits of a response.
  void begin_response();
  /// Sends a response without the HTTP library.
  void send_status(int status);

  bool is_readable() const override { return at_ < head_bytes_; }
  bool is_writable() const override { return wait_until(kWrite, deadline()); }
  /// Copies the next bytes of the head. Returns their number; 0 after the head.
  ssize_t read(char* out, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  enum Event { kRead, kWrite };

  /// Waits until the socket is ready. Returns false at `deadline`, on errors and when stopping.
  bool wait_until(Event event, Clock::time_point deadline) const;
  /// Returns when the next byte of the response must have been sent.
  Clock::time_point deadline() const;

  int socket_;
  const ServerLimits& limits_;
  const std::atomic<bool>& is_stopping_;
  std::string received_;        // The head, and the bytes that the client sent behind it.
  std::size_t head_bytes_ = 0;  // Bytes of the head in received_; 0 until it is complete.
  std::size_t body_bytes_ = 0;  // Bytes of the body behind it that were returned.
  std::size_t at_ = 0;          // The next byte of the head for read().
  Clock::time_point response_start_ = Clock::now();
  std::uint64_t sent_ = 0;  // Bytes of the response.
};

}  // namespace voxdag
