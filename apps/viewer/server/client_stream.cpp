#include "viewer/server/client_stream.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cerrno>

namespace voxdag {
namespace {

using std::chrono::milliseconds;

constexpr std::string_view kHeadEnd = "\r\n\r\n";

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t') || byte == 0x7F;
}

const char* status_line(int status) {
  switch (status) {
    case 400:
      return "400 Bad Request";
    case 408:
      return "408 Request Timeout";
    case 416:
      return "416 Range Not Satisfiable";
    case 431:
      return "431 Request Header Fields Too Large";
    default:
      return "503 Service Unavailable";
  }
}

}  // namespace

RequestHead check_head(std::string_view head, const ServerLimits& limits) {
  RequestHead result;
  int fields = 0, hosts = 0, ranges = 0;
  std::size_t begin = 0;
  for (bool is_first = true;; is_first = false) {
    const std::size_t end = head.find("\r\n", begin);
    const std::string_view line = head.substr(begin, end - begin);
    if (line.empty() && !is_first) break;
    begin = end + 2;
    if (std::any_of(line.begin(), line.end(), is_control)) return {400, true};
    if (is_first) {
      const std::string_view method = line.substr(0, line.find(' '));
      result.may_have_body = method != "GET" && method != "HEAD";
      continue;
    }
    if (++fields > limits.most_fields) return {431, true};
    const std::size_t colon = line.find(':');
    // A name with a space before its colon, or a continued line, means different things to
    // different programs.
    if (colon == 0 || colon == line.npos || line.substr(0, colon).find_first_of(" \t") != line.npos)
      return {400, true};
    const std::string name = lower_case(line.substr(0, colon));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (name == "host") ++hosts;
    if (name == "transfer-encoding" || (name == "content-length" && value != "0") ||
        name == "expect" || name == "upgrade")
      result.may_have_body = true;
    if (name != "range") continue;
    if (++ranges > 1 || value.size() > limits.most_range_bytes ||
        std::count(value.begin(), value.end(), ',') >= limits.most_ranges)
      result.refusal = 416;
  }
  if (hosts > 1) return {400, true};
  return result;
}

bool ClientStream::wait_until(Event event, Clock::time_point deadline) const {
  constexpr milliseconds kStep{100};  // the time after which a stop is noticed
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
  received_.erase(0, head_bytes_);
  head_bytes_ = at_ = 0;
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
