#include "lab/papers/camera_paths.hpp"

#include <algorithm>
#include <array>

#include "lab/papers/paper_scenes.hpp"

namespace voxdag::lab {
namespace {

// The flight leaves the upper gallery, goes down the court to the lion at its end, turns past an
// urn, rises into the gallery at the side, and ends above the court. Units are centimetres.
constexpr std::array kCrytekSponza{
    SceneKey{0, {1060, 690, 78}, {-300, 420, -40}},
    SceneKey{2, {880, 650, 75}, {-500, 330, -40}},
    SceneKey{4.5, {420, 430, -20}, {-800, 220, -40}},
    SceneKey{7, {-250, 210, -50}, {-1250, 170, -40}},
    SceneKey{9.5, {-960, 165, -50}, {-1400, 155, -35}},
    SceneKey{11.2, {-1130, 180, -70}, {-1230, 130, -460}},
    SceneKey{12.6, {-1150, 195, -50}, {-820, 190, -330}},
    SceneKey{13.8, {-1040, 225, -40}, {-300, 330, 40}},
    SceneKey{16, {-790, 480, -10}, {-200, 560, 200}},
    SceneKey{17.5, {-615, 625, 65}, {-280, 620, 320}},
    SceneKey{18.6, {-517, 640, 205}, {-240, 615, 460}},
    SceneKey{20, {-310, 630, 380}, {500, 610, 390}},
    SceneKey{22, {150, 630, 410}, {850, 610, 340}},
    SceneKey{23.6, {490, 640, 395}, {880, 610, 140}},
    SceneKey{25, {585, 660, 255}, {560, 600, -200}},
    SceneKey{26.1, {600, 700, 110}, {150, 560, -260}},
    SceneKey{28, {720, 950, -30}, {-600, 330, -40}},
};

// The flight goes around the fountain, through the arcade, up along the balustrade of the gallery,
// and looks back from the far corner. Units are metres.
constexpr std::array kSanMiguel{
    SceneKey{0, {21.3, -11.3, 6.5}, {10, 0, 2.2}},
    SceneKey{3, {17.3, -9.6, 4.2}, {11.5, -0.5, 2}},
    SceneKey{6, {13, -7.4, 2}, {15, -3.2, 1.3}},
    SceneKey{8.2, {11.6, -4.2, 1.7}, {15.5, -2, 1.6}},
    SceneKey{9.8, {11.2, -1.6, 1.75}, {15, 1.2, 1.8}},
    SceneKey{11.2, {11.6, 0.5, 1.8}, {19, 1.4, 1.9}},
    SceneKey{13, {14.2, 1.65, 1.8}, {21, -0.2, 1.9}},
    SceneKey{15.2, {18.4, 1.65, 1.8}, {18.2, -3.5, 1.6}},
    SceneKey{17, {21.75, 0.2, 2}, {15.5, -4.5, 1.8}},
    SceneKey{18.8, {21.2, -2.6, 3.1}, {14, -4.2, 3}},
    SceneKey{20.5, {19.8, -3.2, 6.2}, {11, -0.4, 6.6}},
    SceneKey{23, {14.6, -2.2, 7.4}, {7.5, 0.2, 7.2}},
    SceneKey{25.2, {11.2, -4.6, 8}, {12, 0.5, 7}},
    SceneKey{28, {10, -10.3, 8.6}, {15, -0.5, 3.4}},
};

// The flight comes down into the nave, goes through the side aisle, looks up in the crossing, and
// turns back to the nave in front of the apse. Units are metres.
constexpr std::array kSibenik{
    SceneKey{0, {25, 10.2, 0}, {0, 6, 0}},          SceneKey{3, {21, 5, -0.8}, {4, 4, 0.6}},
    SceneKey{5, {19, 3.2, 1.2}, {10, 3, 3.3}},      SceneKey{6.3, {17.8, 2.85, 4}, {9, 3, 3.6}},
    SceneKey{8, {15.2, 2.8, 5.8}, {6, 3.2, 3}},     SceneKey{10, {11.6, 3, 5.3}, {2, 4.5, 1}},
    SceneKey{11.5, {9.8, 3.5, 3.6}, {-3, 6, -0.5}}, SceneKey{13.5, {6.3, 5.3, 1}, {-8, 7, 0}},
    SceneKey{16, {1.8, 7.8, 0}, {-4.5, 13, 0}},     SceneKey{18, {-1.5, 8.6, -0.5}, {-7, 8, 7}},
    SceneKey{20, {-2.6, 8.6, -0.7}, {4, 5.5, 7}},   SceneKey{21.6, {-4.6, 7.9, -0.3}, {11, 6.2, 1}},
    SceneKey{24, {-8.6, 7.2, 0}, {12, 6, 0}},
};

constexpr std::array kFlights{
    SceneFlight{.name = "crytek_sponza",
                .file = "sponza.obj",
                .file_check = kCrytekSponzaCheck,
                .clearance = 35,
                .up = {0, 1, 0},
                .fov_degrees = 60,
                .sun_direction = {0.3, 1, 0.35},
                .keys = kCrytekSponza},
    SceneFlight{.name = "sanmiguel",
                .file = "sanmiguel_core.ply",
                .file_check = kSanMiguelCoreCheck,
                .clearance = 0.75,
                .up = {0, 0, 1},
                .fov_degrees = 60,
                .sun_direction = {0.4, -0.45, 1},
                .keys = kSanMiguel},
    SceneFlight{.name = "sibenik",
                .file = "sibenik.obj",
                .file_check = kSibenikCheck,
                .clearance = 0.75,
                .up = {0, 1, 0},
                .fov_degrees = 60,
                .sun_direction = {0.4, 1, 0.3},
                .keys = kSibenik},
};

}  // namespace

std::span<const SceneFlight> scene_flights() { return kFlights; }

const SceneFlight* flight_of(std::uint64_t file_check) {
  const auto* found =
      std::find_if(kFlights.begin(), kFlights.end(),
                   [&](const SceneFlight& flight) { return flight.file_check == file_check; });
  return found == kFlights.end() ? nullptr : found;
}

ScenePreset preset_of(const SceneFlight& flight) {
  const SceneKey& first = flight.keys.front();
  return {first.eye,          first.target,         flight.up,
          flight.fov_degrees, flight.sun_direction, {flight.keys.begin(), flight.keys.end()}};
}

PathFile path_file(const ScenePreset& preset) {
  PathFile path;
  path.sun = preset.sun_direction;
  path.keys = path_keys(preset.flight, preset.up, preset.fov_degrees);
  return path;
}

}  // namespace voxdag::lab
