#pragma once
/// Adds the name of a file to errors.
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Calls work() and returns its result. An Error that it throws gets the name of the file if it
/// names none, or the file `replaced`; Cancelled and OverMemory pass unchanged.
template <class Work>
auto with_file_name(const std::string& file, const Work& work, const std::string& replaced = {}) {
  try {
    return work();
  } catch (const Cancelled&) {
    throw;
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    if (!error.file().empty() && error.file() != replaced) throw;
    throw error.in_file(file);
  }
}

}  // namespace voxdag
