#pragma once
/// Figure 1 of the SVDAG paper: triangles lit through the finest DAG, and the rates of its rays.
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "lab/report/document.hpp"
#include "lab/reproduce/painter.hpp"
#include "lab/reproduce/svdag/flight.hpp"

namespace voxdag::lab {

struct SvdagFigure1 {
  CellResult build;
  ScenePicture picture;
  FlightRun rays;  ///< Of the picture's view.
};

/// Measures EpicCitadel or, if another scene is closer to the paper's, that one. Returns nothing
/// without a scene that has a view. Throws Error and Cancelled.
std::optional<SvdagFigure1> measure_figure1(const PapersPlan& plan,
                                            const std::vector<FoundScene>& scenes, CellStore& cells,
                                            const Progress& progress);

Section figure1_section(const SvdagFigure1& figure);
nlohmann::ordered_json figure1_json(const SvdagFigure1& figure);

}  // namespace voxdag::lab
