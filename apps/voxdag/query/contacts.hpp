#pragma once
/// `voxdag query --overlap`, `--sweep`, `--closest` and `--signed-distances`.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/length.hpp"
#include "cli/session.hpp"
#include "voxdag/file/model/scene_model.hpp"

namespace voxdag::cli {

struct ContactArguments {
  std::string overlap, sweep, closest, signed_distances;  ///< The array of shapes; one at most.
  std::optional<Length> within;

  bool is_asked() const { return !rows().empty(); }
  const std::string& rows() const {
    return !overlap.empty()   ? overlap
           : !sweep.empty()   ? sweep
           : !closest.empty() ? closest
                              : signed_distances;
  }
};

/// Adds the options to `query`. `add` registers each kind of question.
void add_contact_options(const Command& command, ContactArguments& arguments,
                         const std::function<Option(Option)>& add);

/// Writes the answers to `output` and returns what they are. Throws Error and Cancelled.
std::string answer_contacts(const ContactArguments& arguments, const std::string& output,
                            const DagModel& file, Session& session);

}  // namespace voxdag::cli
