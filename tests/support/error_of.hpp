#pragma once
/// The message of the error that work throws.
#include <functional>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// Returns what() of the Error that `work` throws, or "no error".
inline std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace voxdag
