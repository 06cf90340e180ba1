#include "viewer/server/server_address.hpp"

#include <arpa/inet.h>
#include <unistd.h>

namespace voxdag {

std::string host_of(const std::string& field) {
  const std::size_t bracket = field.find(']');
  const std::size_t colon = field.find(':', bracket == field.npos ? 0 : bracket);
  return field.substr(0, colon);
}

bool is_loopback(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET6)
    return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
  const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(address);
  return address.ss_family == AF_INET && ntohl(ipv4.sin_addr.s_addr) >> 24 == 127;
}

int port_of(const sockaddr_storage& address) {
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

std::string url_host(const std::string& address) {
  if (address == "0.0.0.0" || address == "::") {
    char name[256] = {};
    if (gethostname(name, sizeof name - 1) == 0 && name[0] != '\0') return name;
  }
  return address.find(':') == address.npos ? address : "[" + address + "]";
}

}  // namespace voxdag
