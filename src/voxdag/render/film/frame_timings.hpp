#pragma once
/// The time that each frame of a film took, as CSV.
#include <cstdint>
#include <string>
#include <vector>

namespace voxdag {

struct FrameTiming {
  int frame = 0;
  double time = 0;       ///< Time in the film, seconds.
  double render_ms = 0;  ///< Casting and shading.
  double write_ms = 0;   ///< Encoding and writing the picture.
  std::uint64_t rays = 0;

  double mrays_per_second() const {
    return render_ms > 0 ? static_cast<double>(rays) / render_ms * 1e-3 : 0;
  }
};

/// Returns a header line and a line per frame.
std::string timings_csv(const std::vector<FrameTiming>& frames);

}  // namespace voxdag
