#pragma once
/// Checks the heads of requests.
#include <string_view>

#include "viewer/server/server_limits.hpp"

namespace voxdag {

/// The head of a request: its first line and its header fields.
struct RequestHead {
  /// The status of a request that the HTTP library must not see: 400, 413, 416 or 431. 0: none.
  int refusal = 0;
  /// There may be a body that the server does not read: it closes the connection afterwards.
  bool may_have_body = false;
  /// Bytes of the body that the server must read: of POST with Content-Length, if it takes bodies.
  std::size_t body_bytes = 0;
};

/// Checks a complete head before the HTTP library parses it: the number of fields, Range, control
/// characters. Version 0.11 of the library matches Range by a recursive std::regex, which long
/// fields would overflow.
RequestHead check_head(std::string_view head, const ServerLimits& limits,
                       bool takes_bodies = false);

}  // namespace voxdag
