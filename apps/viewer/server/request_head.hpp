#pragma once
/// Checks the heads of requests.
#include <string_view>

#include "viewer/server/server_limits.hpp"

namespace voxdag {

/// The head of a request: its first line and its header fields.
struct RequestHead {
  /// The status of a request that the HTTP library must not see: 400, 416 or 431. 0: none.
  int refusal = 0;
  /// The server reads no bodies, so it closes the connection after such a request.
  bool may_have_body = false;
};

/// Checks a complete head before the HTTP library parses it: the number of fields, Range, control
/// characters. Version 0.11 of the library matches Range by a recursive std::regex, which long
/// fields would overflow.
RequestHead check_head(std::string_view head, const ServerLimits& limits);

}  // namespace voxdag
