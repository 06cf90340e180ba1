#pragma once
/// The plan of `voxdag bench papers`: scenes, resolutions, and limits of time and memory.
#include <cstdint>
#include <filesystem>
#include <vector>

#include "lab/reproduce/papers_device.hpp"
#include "voxdag/image/image_size.hpp"

namespace voxdag::lab {

/// The fly-through of Figures 6 to 8 of the SVDAG paper.
struct FlightPlan {
  int esvo_levels = 12;       ///< Of the DAG and the ESVO that are compared; the paper's 4096³.
  int triangles_levels = 15;  ///< Of the DAG that is compared with triangles; the paper's 32768³.
  int frames = 30;
  ImageSize size{1024, 768};
  std::vector<double> lamps{0.02, 0.05, 0.1, 0.2, 0.4, 0.8};  ///< Radius / distance, in Figure 7b.
};

/// The pictures of Figures 4 and 8b of the SVDAG paper.
struct PicturePlan {
  int levels = 13;
  ImageSize size{960, 540};
};

/// The tables and pictures of the ESVO paper.
struct EsvoPlan {
  std::vector<int> levels{10, 11, 12, 13, 14, 15, 16};                  ///< Of Tables 1 and 2.
  std::vector<ImageSize> sizes{{512, 384}, {1024, 768}, {2048, 1536}};  ///< Of Table 2.
  int picture_levels = 11;
  std::vector<int> coarse_levels{6, 7, 8};  ///< Of Figures 4 and 5.
  int filter_levels = 9;                    ///< Of Figures 10 and 11.
};

struct PapersPlan {
  std::filesystem::path scenes;   ///< Folder of meshes; empty: procedural stand-ins only.
  bool small_stand_ins = false;   ///< Procedural stand-ins of about half a million triangles.
  std::filesystem::path folder;   ///< Where the report and its results go.
  std::filesystem::path scratch;  ///< Folder for voxels; bench_papers() sets it.
  std::vector<std::string> only;  ///< Names of paper scenes; empty: all.
  std::vector<int> table1_levels{9, 10, 11, 12, 13};
  std::vector<int> table2_levels{11, 12, 13, 14, 15, 16};
  int figure1_levels = 17;  ///< Of Figure 1 of the SVDAG paper; the paper's 131072³.
  FlightPlan flight;
  PicturePlan pictures;
  EsvoPlan esvo;
  double cell_seconds = 600;       ///< Time limit of one build for the tables.
  std::uint64_t memory_bytes = 0;  ///< `--memory` of every build; 0: its default.
  int threads = 0;                 ///< 0: one per processor.
  DeviceChoice device_choice;      ///< Casts rays and renders pictures.
  PapersDevice device;             ///< The chosen device; bench_papers() sets it.
};

/// Makes the plan one that finishes within minutes: coarse grids and procedural stand-ins alone.
inline void make_quick(PapersPlan& plan) {
  plan.scenes.clear();
  plan.small_stand_ins = true;
  plan.table1_levels = {9, 10, 11};
  plan.table2_levels = {9, 10, 11};
  plan.figure1_levels = 13;
  plan.cell_seconds = 20;
  plan.flight = {10, 12, 6, {512, 384}, {0.05, 0.4}};
  plan.pictures = {11, {640, 360}};
  plan.esvo = {{7, 8}, {{512, 384}}, 8, {6, 7}, 8};
}

}  // namespace voxdag::lab
