#pragma once
/// Any program that builds from a mesh: `bench build --rival NAME=COMMAND`.
#include <string>

#include "bench/rivals/rival.hpp"

namespace voxdag {

class CommandRival : public Rival {
 public:
  /// `command` is for the shell. {mesh} and {out} stand for quoted paths, {resolution} and {levels}
  /// for the grid. The command runs in an empty folder, which is removed afterwards; {out} is in
  /// it.
  CommandRival(std::string name, std::string command);

  std::optional<RivalBuild> build(const RivalTask& task, Progress& progress) override;

 private:
  std::string command_;
};

}  // namespace voxdag
