#pragma once
/// Runs long work outside of Python, so that other threads run and Ctrl-C works.
#include <pybind11/pybind11.h>

#include <chrono>
#include <future>

#include "voxdag/core/parallel/work.hpp"

namespace voxdag::python {

/// Calls body(work) on another thread without the GIL and returns its result. Ctrl-C cancels
/// the work and raises KeyboardInterrupt. Passes exceptions of the work on.
template <class Body>
auto run_work(const Body& body) {
  Progress progress;
  auto result = std::async(std::launch::async, [&] { return body(Work(&progress)); });
  bool is_interrupted = false;
  {
    const pybind11::gil_scoped_release release;
    while (result.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      const pybind11::gil_scoped_acquire acquire;
      if (is_interrupted || PyErr_CheckSignals() == 0) continue;
      is_interrupted = true;
      progress.cancel();
    }
  }
  if (is_interrupted) {
    result.wait();
    throw pybind11::error_already_set();
  }
  return result.get();
}

}  // namespace voxdag::python
