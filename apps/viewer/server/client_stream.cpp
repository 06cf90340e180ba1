#include "viewer/server/client_stream.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace voxdag {
namespace {

using std::chrono::milliseconds;

constexpr std::string_view kHeadEnd = "\r\n\r\n";

const char* status_line(int status) {
  switch (status) {
    case 400:
      return "400 Bad Request";
    case 408:
      return "408 Request Timeout";
    case 413:
      return "413 Content Too Large";
    case 416:
      return "416 Range Not Satisfiable";
    case 431:
      return "431 Request Header Fields Too Large";
    default:
      return "503 Service Unavailable";
  }
}

}  // namespace

bool ClientStream::wait_until(Event event, Clock::time_point deadline) const {
  constexpr milliseconds kStep{100};  // A stop is noticed after this time.
  for (;;) {
    if (is_stopping_) return false;
    const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    pollfd wanted{socket_, static_cast<short>(event == kRead ? POLLIN : POLLOUT), 0};
    const int ready = poll(&wanted, 1, static_cast<int>(std::min(left, kStep).count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

HeadResult ClientStream::receive_head() {
  received_.erase(0, head_bytes_ + body_bytes_);
  head_bytes_ = body_bytes_ = at_ = 0;
  const Clock::time_point first = Clock::now();
  Clock::time_point deadline = first + (received_.empty() ? limits_.idle : limits_.head);
  for (std::size_t searched = 0;;) {
    const std::size_t end = received_.find(kHeadEnd, searched);
    if (end != received_.npos && end + kHeadEnd.size() <= limits_.most_head_bytes) {
      head_bytes_ = end + kHeadEnd.size();
      return HeadResult::kComplete;
    }
    if (received_.size() >= limits_.most_head_bytes) return HeadResult::kTooLarge;
    searched = received_.size() < 3 ? 0 : received_.size() - 3;
    if (!wait_until(kRead, deadline))
      return received_.empty() || is_stopping_ ? HeadResult::kClosed : HeadResult::kTooSlow;
    char bytes[4096];
    const std::size_t most = std::min(sizeof bytes, limits_.most_head_bytes - received_.size());
    const ssize_t got = recv(socket_, bytes, most, MSG_DONTWAIT);
    if (got < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK)) continue;
    if (got <= 0) return HeadResult::kClosed;
    if (received_.empty()) deadline = Clock::now() + limits_.head;
    received_.append(bytes, static_cast<std::size_t>(got));
  }
}

std::optional<std::string> ClientStream::receive_body(std::size_t size) {
  const Clock::time_point deadline = Clock::now() + limits_.body;
  while (received_.size() < head_bytes_ + size) {
    if (!wait_until(kRead, deadline)) return {};
    char bytes[4096];
    const std::size_t most = std::min(sizeof bytes, head_bytes_ + size - received_.size());
    const ssize_t got = recv(socket_, bytes, most, MSG_DONTWAIT);
    if (got < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK)) continue;
    if (got <= 0) return {};
    received_.append(bytes, static_cast<std::size_t>(got));
  }
  body_bytes_ = size;
  return received_.substr(head_bytes_, size);
}

void ClientStream::begin_response() {
  response_start_ = Clock::now();
  sent_ = 0;
}

void ClientStream::send_status(int status) {
  const std::string text = std::string("HTTP/1.1 ") + status_line(status) +
                           "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
  // One attempt: the socket's empty buffer takes it, or the client does not read.
  (void)!send(socket_, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

ssize_t ClientStream::read(char* out, std::size_t size) {
  const std::size_t count = std::min(size, head_bytes_ - at_);
  std::copy_n(received_.data() + at_, count, out);
  at_ += count;
  return static_cast<ssize_t>(count);
}

ClientStream::Clock::time_point ClientStream::deadline() const {
  const std::chrono::duration<double> fair(static_cast<double>(sent_) / limits_.least_rate);
  const Clock::time_point stalled = Clock::now() + limits_.stall;
  // Past ten years of time the sum would overflow.
  if (fair > std::chrono::hours(24 * 3650)) return stalled;
  return std::min(
      stalled, response_start_ + limits_.grace + std::chrono::duration_cast<Clock::duration>(fair));
}

ssize_t ClientStream::write(const char* bytes, std::size_t size) {
  for (;;) {
    if (!wait_until(kWrite, deadline())) return -1;
    const ssize_t sent = send(socket_, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK)) continue;
    if (sent > 0) sent_ += static_cast<std::uint64_t>(sent);
    return sent;
  }
}

// The server uses neither address.
void ClientStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = "";
  port = 0;
}

void ClientStream::get_local_ip_and_port(std::string& ip, int& port) const {
  get_remote_ip_and_port(ip, port);
}

}  // namespace voxdag
