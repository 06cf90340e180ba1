#include "voxdag/core/io/load_module.hpp"

namespace voxdag {

const void* load_module(const char* file, const char*, std::string& reason) {
  reason = std::string(file) + ": a browser loads no modules";
  return nullptr;
}

}  // namespace voxdag
