#pragma once
/// Ctrl-C and termination as cancellation.
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// From now on SIGINT, SIGTERM and SIGHUP cancel `progress`, which must live as long as the
/// process. A second signal of the kind ends the process at once. Signals of failed writes
/// (SIGPIPE, SIGXFSZ) are ignored, so that they are seen as errors of the write.
void cancel_on_signals(Progress& progress);

/// The signal that cancelled, or 0.
int cancelling_signal();

}  // namespace voxdag
