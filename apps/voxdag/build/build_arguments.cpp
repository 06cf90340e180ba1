#include "build/build_arguments.hpp"

namespace voxdag::cli {

std::map<std::string, std::string> build_settings(const BuildArguments& arguments) {
  std::map<std::string, std::string> settings = settings_of(arguments.grid);
  if (arguments.solid)
    add_solid_settings({*arguments.solid, arguments.winding_threshold}, settings);
  return settings;
}

}  // namespace voxdag::cli
