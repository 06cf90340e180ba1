#pragma once
/// Runs any program that builds from a mesh: `bench build --rival NAME=COMMAND`.
#include <string>

#include "lab/rivals/rival.hpp"

namespace voxdag::lab {

class CommandRival : public Rival {
 public:
  /// The shell runs `command`. {mesh} and {out} stand for quoted paths, {resolution} and {levels}
  /// for the grid. The command runs in an empty folder, which contains {out} and is removed
  /// afterwards.
  CommandRival(std::string name, std::string command);

  std::optional<RivalBuild> build(const RivalTask& task, Progress& progress) override;

 private:
  std::string command_;
};

}  // namespace voxdag::lab
