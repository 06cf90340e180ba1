#pragma once
/// The message or the reason of the error that work throws.
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// Returns the message of the Error that `work` throws, or "no error".
template <class Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Returns the reason, without file and place, of the Error that `work` throws, or "no error".
template <class Work>
std::string reason_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.reason();
  }
  return "no error";
}

}  // namespace voxdag
