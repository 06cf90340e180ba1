#pragma once
/// The files that a script of edits stamps into a DAG.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/output_files.hpp"
#include "cli/session.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/edit/place_stamp.hpp"

namespace voxdag::cli {

struct StampRequest {
  std::string file;    ///< A .vdag file, or a mesh that `voxdag build` reads.
  bool solid = false;  ///< Fill the mesh, by parity.
  StampPlace place;
};

/// Reads each file once.
class StampFiles {
 public:
  /// Stamps come into `grid`. No stamp may be one of `outputs`.
  StampFiles(const Grid& grid, std::vector<OutputFile> outputs, MemoryBudget& memory,
             Session& session)
      : grid_(grid), outputs_(std::move(outputs)), memory_(memory), session_(session) {}

  /// Returns the voxels of a stamp in the grid. A mesh that is neither moved nor turned has the
  /// voxels that `voxdag build --grid-of` gives it. Throws Error.
  PlacedStamp place(const StampRequest& request);

 private:
  struct Stamp {
    Svdag dag;
    Grid grid;
  };
  Stamp read(const StampRequest& request, bool is_in_place);
  Stamp read_mesh(const StampRequest& request, bool is_in_place);

  const Grid grid_;
  const std::vector<OutputFile> outputs_;
  MemoryBudget& memory_;
  Session& session_;
  std::map<std::string, Stamp> stamps_;
};

}  // namespace voxdag::cli
