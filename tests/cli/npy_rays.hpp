#pragma once
/// Makes files of rays for `voxdag trace`.
#include <array>
#include <string>
#include <vector>

namespace voxdag::cli {

/// Returns the bytes of the file that NumPy writes for a float32 array of shape (N, 8).
inline std::string rays_npy(const std::vector<std::array<float, 8>>& rays) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                       std::to_string(rays.size()) + ", 8), }";
  header.resize(117, ' ');
  header += '\n';
  std::string text("\x93NUMPY\x01\x00", 8);
  text += static_cast<char>(header.size());
  text += '\0';
  text += header;
  text.append(reinterpret_cast<const char*>(rays.data()), rays.size() * sizeof rays[0]);
  return text;
}

}  // namespace voxdag::cli
