#pragma once
/// A plain HTTP client over a socket. It sends exactly the bytes of the test.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

namespace voxdag {

struct HttpAnswer {
  int status = 0;                             ///< 0: the server sent no complete head.
  std::map<std::string, std::string> fields;  ///< Names in lower case.
  std::string body;
  bool is_complete = false;  ///< The body has the bytes that Content-Length says.
};

class HttpClient {
 public:
  /// Connects to a port of 127.0.0.1.
  explicit HttpClient(int port, int receive_buffer = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0)
      setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ = connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    EXPECT_TRUE(is_connected_);
  }
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;
  ~HttpClient() { ::close(socket_); }

  /// Returns false if the server has closed the connection.
  bool send(const std::string& text) {
    std::size_t sent = 0;
    while (sent < text.size()) {
      const ssize_t n = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }

  /// Reads until `received` has `bytes` bytes. Returns false if the connection ends before.
  bool fill(std::size_t bytes, std::chrono::milliseconds patience = std::chrono::seconds(20)) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (received.size() < bytes) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          end - std::chrono::steady_clock::now());
      pollfd wanted{socket_, POLLIN, 0};
      if (left.count() <= 0 || poll(&wanted, 1, static_cast<int>(left.count())) <= 0) return false;
      char buffer[65536];
      const ssize_t n = recv(socket_, buffer, sizeof buffer, 0);
      if (n <= 0) {
        is_closed_ = true;
        return false;
      }
      received.append(buffer, static_cast<std::size_t>(n));
    }
    return true;
  }

  /// Reads an answer and removes its bytes from `received`.
  HttpAnswer answer(bool is_head = false) {
    HttpAnswer answer;
    std::size_t end = std::string::npos;
    while ((end = received.find("\r\n\r\n")) == std::string::npos)
      if (!fill(received.size() + 1)) return answer;
    parse_head(received.substr(0, end + 2), answer);
    received.erase(0, end + 4);
    const auto length = answer.fields.find("content-length");
    const std::size_t bytes = is_head || length == answer.fields.end()
                                  ? 0
                                  : std::strtoull(length->second.c_str(), nullptr, 10);
    answer.is_complete = fill(bytes);
    answer.body = received.substr(0, bytes);
    received.erase(0, answer.body.size());
    return answer;
  }

  /// Returns whether the server closes the connection within the time.
  bool is_closed_within(std::chrono::milliseconds time) {
    while (!is_closed_ && fill(received.size() + 1, time)) {
    }
    return is_closed_;
  }

  std::string received;  ///< Bytes that the server sent and that no answer has taken yet.

 private:
  static void parse_head(const std::string& head, HttpAnswer& answer) {
    answer.status = std::atoi(head.c_str() + std::min<std::size_t>(9, head.size()));
    for (std::size_t at = head.find("\r\n") + 2; at < head.size();) {
      const std::size_t end = head.find("\r\n", at), colon = head.find(':', at);
      std::string name = head.substr(at, colon - at);
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      answer.fields[name] = head.substr(colon + 2, end - colon - 2);
      at = end + 2;
    }
  }

  int socket_;
  bool is_connected_ = false, is_closed_ = false;
};

inline std::string request(const std::string& target, const std::string& fields = {},
                           const std::string& method = "GET") {
  return method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
}

/// Sends one request on a connection of its own.
inline HttpAnswer ask(int port, const std::string& text, bool is_head = false) {
  HttpClient client(port);
  client.send(text);
  return client.answer(is_head);
}

inline HttpAnswer get(int port, const std::string& target, const std::string& fields = {}) {
  return ask(port, request(target, fields));
}

}  // namespace voxdag
