#pragma once
/// The rules of solids, by the names that they have in options and in the metadata of files.
#include <map>
#include <string>

#include "voxdag/builders/solid/fill_solid.hpp"

namespace voxdag {

/// Returns "parity", "winding" or "flood".
std::string name_of(SolidRule rule);
/// Returns the rule with this name. Throws std::invalid_argument if there is none.
SolidRule solid_rule(const std::string& name);

/// Adds to VdagMetadata::build what solid_options() reads.
void add_solid_settings(const SolidOptions& options, std::map<std::string, std::string>& settings);
/// Returns the options in VdagMetadata::build, which must have "solid". Throws
/// std::invalid_argument.
SolidOptions solid_options(const std::map<std::string, std::string>& settings);

}  // namespace voxdag
