#pragma once
/// A paper's scene in the JSON of the benchmarks.
#include <nlohmann/json.hpp>

#include "lab/papers/paper_scenes.hpp"

namespace voxdag::lab {

/// Adds "paper_scene" with name, state and difference to `json`, if there is a scene.
inline void add_paper_scene(nlohmann::ordered_json& json, const PaperMatch& match) {
  if (match.scene == nullptr) return;
  json["paper_scene"] = {{"name", match.scene->name},
                         {"state", name_of(match.state)},
                         {"difference", match.difference}};
}

}  // namespace voxdag::lab
