#pragma once
/// Turns signals into cancellation and errors.
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::cli {

/// From now on a write to a closed pipe or past the limit of a file's size is an error instead of a
/// signal, and so is one to a standard stream that the caller closed: without this the next file
/// opened would take its place and its text.
void make_writes_return_errors();

/// Installs handlers: SIGINT, SIGTERM and SIGHUP cancel `progress`, which must live as long as the
/// process. A second signal removes unfinished output and ends the process immediately.
void cancel_on_signals(Progress& progress);

/// Returns the signal that cancelled the work, or 0.
int cancelling_signal();

}  // namespace voxdag::cli
