#include "cli/environment_input.hpp"

#include "voxdag/image/light_image.hpp"

namespace voxdag::cli {

Option add_environment_option(const Command& command, std::string& value, const std::string& help) {
  return command.text(
      "--environment", value, "FILE|NAME",
      help + ": an equirectangular .hdr or .exr file, or studio, overcast or sunset");
}

void note_environment_file(const std::string& value, Session& session) {
  if (!is_built_in_environment(value)) session.inputs.push_back(value);
}

std::shared_ptr<const Environment> read_environment(const std::string& value) {
  if (value.empty()) return nullptr;
  if (is_built_in_environment(value))
    return std::make_shared<Environment>(built_in_environment(value));
  try {
    return std::make_shared<Environment>(read_light_image(value));
  } catch (const Error& error) {
    throw error.in_file(value);
  }
}

}  // namespace voxdag::cli
