#pragma once
/// The address of the server, in sockets, URLs and requests.
#include <sys/socket.h>

#include <string>

namespace voxdag {

bool is_loopback(const sockaddr_storage& address);
int port_of(const sockaddr_storage& address);

/// Returns the host for the URL of a server that listens on `address`: "[::1]" for "::1". For an
/// address that stands for all, returns the name of this machine.
std::string url_host(const std::string& address);

/// Returns the host of a Host field without its port: "[::1]" for "[::1]:80".
std::string host_of(const std::string& field);

}  // namespace voxdag
