#pragma once
/// The limits of the server.
#include <chrono>
#include <cstddef>

namespace voxdag {

/// Limits of what a client may use. A client that exceeds one of them loses its connection.
struct ServerLimits {
  int most_connections = 128;
  std::size_t most_head_bytes = 16384;      ///< Bytes of a request's first line and header fields.
  int most_fields = 100;                    ///< Number of header fields of a request.
  std::size_t most_range_bytes = 512;       ///< Bytes of the field Range.
  int most_ranges = 16;                     ///< Number of ranges in the field Range.
  std::size_t most_body_bytes = 65536;      ///< Bytes of a body, of servers that take some.
  std::chrono::milliseconds head{10'000};   ///< Time from the first byte of a head to its last.
  std::chrono::milliseconds body{10'000};   ///< Time from the end of a head to that of its body.
  std::chrono::milliseconds idle{30'000};   ///< Time until the first byte of the next request.
  std::chrono::milliseconds stall{15'000};  ///< Time without progress of a response.
  /// A response must have `least_rate` bytes per second on average once it has taken `grace`.
  std::chrono::milliseconds grace{60'000};
  double least_rate = 1024;
};

}  // namespace voxdag
