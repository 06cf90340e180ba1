/// Prints the JavaScript module constants.js: the numbers that the page shares with the library,
/// taken from its headers. The build runs it.
#include <cctype>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/layout/value_pages.hpp"
#include "voxdag/render/exposure.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/render/stored_look.hpp"
#include "voxdag/render/surface_normal.hpp"
#include "voxdag/render/surface_point.hpp"
#include "voxdag/render/tone_map.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json vector(Vec3<T> v) {
  return Json::array({v.x, v.y, v.z});
}

/// The container of .vdag files; offsets are in bytes.
Json file_constants() {
  Json ids;
  for (const std::uint32_t id : {kChunkMeta, kChunkLevels, kChunkNodes, kChunkLeafBlocks,
                                 kChunkCompactHead, kChunkCompactStream, kChunkEsvo,
                                 kChunkEsvoBlocks, kChunkCellIndex, kChunkColors, kChunkNormals})
    ids[vdag_chunk_name(id)] = id;
  return {{"magic", kVdagMagic},
          {"version", kVdagVersion},
          {"alignment", kVdagAlignment},
          {"mostChunks", kVdagMostChunks},
          {"mostMetadataBytes", kVdagMostMetadataBytes},
          {"requiredFlag", kVdagChunkRequired},
          {"headerBytes", sizeof(VdagHeader)},
          {"header",
           {{"version", offsetof(VdagHeader, version)},
            {"chunkCount", offsetof(VdagHeader, chunk_count)},
            {"fileBytes", offsetof(VdagHeader, file_bytes)},
            {"checksum", offsetof(VdagHeader, checksum)},
            {"reserved", offsetof(VdagHeader, reserved)}}},
          {"chunkEntryBytes", sizeof(VdagChunkEntry)},
          {"chunkEntry",
           {{"id", offsetof(VdagChunkEntry, id)},
            {"flags", offsetof(VdagChunkEntry, flags)},
            {"offset", offsetof(VdagChunkEntry, offset)},
            {"length", offsetof(VdagChunkEntry, length)},
            {"checksum", offsetof(VdagChunkEntry, checksum)}}},
          {"ids", ids}};
}

Json dag_constants() {
  return {{"leastLevels", kMinLevels},
          {"mostLevels", kMaxLevels},
          {"leafLevels", 2},  // A leaf block is 4³ voxels.
          {"subvoxels", kSubvoxels}};
}

Json cell_index_constants() {
  return {{"headerBytes", sizeof(CellIndexHeader)},
          {"finestLevel", offsetof(CellIndexHeader, finest_level)},
          {"cells", offsetof(CellIndexHeader, cells)},
          {"width", offsetof(CellIndexHeader, width)}};
}

Json pages_constants() {
  Json channel_bits = Json::array();
  for (int code = 0; code <= 3; ++code) {
    const EndPrecision precision{code};
    channel_bits.push_back(
        {precision.channel_bits(0), precision.channel_bits(1), precision.channel_bits(2)});
  }
  return {{"headerBytes", sizeof(ValuePagesHeader)},
          {"precision", offsetof(ValuePagesHeader, precision)},
          {"values", offsetof(ValuePagesHeader, values)},
          {"words", offsetof(ValuePagesHeader, words)},
          {"pageValues", kPageValues},
          {"groupPages", kGroupPages},
          {"blockUnit", kBlockUnit},
          {"headerBits", ValueBlock::kHeaderBits},
          {"typeBits", 3},
          {"stepBits", ValueBlock::kStepBits},
          {"stepUnit", ValueBlock::kStepUnit},
          {"flat", static_cast<int>(ValueBlock::kFlat)},
          {"raw", static_cast<int>(ValueBlock::kRaw)},
          {"channelBits", channel_bits}};
}

Json samples_constants() {
  return {{"sets", SampleTables::kSets}, {"rotations", SampleTables::kRotations}};
}

Json light_constants() {
  const Sky sky;
  const RenderOptions options;
  return {{"sunLight", vector(sky.sun_light)},
          {"zenith", vector(sky.zenith)},
          {"horizon", vector(sky.horizon)},
          {"ground", vector(sky.ground)},
          {"glow", SkyShape::kGlow},
          {"groundSeen", SkyShape::kGround},
          {"groundBegins", SkyShape::kGroundBegins},
          {"groundIsFull", SkyShape::kGroundIsFull},
          {"horizonInDome", SkyShape::kHorizonInDome},
          {"open", SkyShape::kOpen},
          {"fill", SkyShape::kFill},
          {"fillFacing", SkyShape::kFillFacing},
          {"fillAside", SkyShape::kFillAside},
          {"defaultSun", vector(kDefaultSun)},
          {"sunDegrees", options.sun_degrees},
          {"sky", options.sky},
          {"shadowSamples", options.shadow_samples},
          {"occlusionSamples", options.occlusion_samples},
          {"occlusionDistance", kOcclusionDistance},
          {"occlusionCone", options.occlusion_cone},
          {"lodPixels", options.lod_pixels},
          {"cubePixels", options.cube_pixels},
          {"albedo", vector(options.albedo)}};
}

Json exposure_constants() {
  return {{"middle", ExposureRule::kMiddle},       {"bright", ExposureRule::kBright},
          {"white", ExposureRule::kWhite},         {"least", ExposureRule::kLeast},
          {"ofNothing", ExposureRule::kOfNothing}, {"luminance", vector(ExposureRule::kLuminance)}};
}

Json tone_constants() {
  return {{"a", ToneCurve::kA},
          {"b", ToneCurve::kB},
          {"c", ToneCurve::kC},
          {"d", ToneCurve::kD},
          {"e", ToneCurve::kE}};
}

Json normal_constants() {
  return {{"radius", LayerRule::kRadius},
          {"power", LayerRule::kPower},
          {"thin", LayerRule::kThin},
          {"thick", LayerRule::kThick},
          {"plane", LayerRule::kPlane},
          {"edge", LayerRule::kEdge},
          {"outlineCosine", LayerRule::kOutlineCosine},
          {"coarser", LayerRule::kCoarser},
          {"leaning", BackRule::kLeaning},
          {"opposite", BackRule::kOpposite}};
}

Json start_constants() {
  return {{"slack", StartRule::kSlack},
          {"hidden", StartRule::kHidden},
          {"tries", StartRule::kTries},
          {"farthest", StartRule::kFarthest}};
}

Json view_constants() {
  return {{"leastFovDegrees", kLeastFovDegrees}, {"fovDegrees", View{}.vertical_fov_degrees}};
}

/// Returns "PAGE_VALUES" for "pageValues".
std::string upper_snake(const std::string& camel) {
  std::string name;
  for (const char c : camel) {
    if (std::isupper(static_cast<unsigned char>(c)) != 0) name += '_';
    name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return name;
}

std::string glsl_float(const Json& number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", number.get<double>());
  const std::string digits = text;
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

/// Returns the GLSL constant for a value: an int, a float or a vec3. Returns nothing for others.
std::string glsl_value(const Json& value) {
  if (value.is_number_integer()) return value.dump();
  if (value.is_number_float()) return glsl_float(value);
  if (value.is_array() && value.size() == 3 && value[0].is_number_float())
    return "vec3(" + glsl_float(value[0]) + ", " + glsl_float(value[1]) + ", " +
           glsl_float(value[2]) + ")";
  return {};
}

std::string glsl_definitions(const Json& groups) {
  std::string text;
  for (const auto& [group, constants] : groups.items())
    for (const auto& [name, value] : constants.items())
      if (const std::string glsl = glsl_value(value); group != "FILE" && !glsl.empty())
        text += "#define " + group + "_" + upper_snake(name) + " " + glsl + "\n";
  return text;
}

void print_module() {
  const Json groups = {{"FILE", file_constants()},
                       {"DAG", dag_constants()},
                       {"CELL_INDEX", cell_index_constants()},
                       {"PAGES", pages_constants()},
                       {"SAMPLES", samples_constants()},
                       {"LIGHT", light_constants()},
                       {"EXPOSURE", exposure_constants()},
                       {"TONE", tone_constants()},
                       {"NORMAL", normal_constants()},
                       {"START", start_constants()},
                       {"VIEW", view_constants()}};
  std::printf(
      "// Made from the headers of voxdag by apps/viewer/generate/constants.cpp. Do not edit.\n"
      "export const VERSION = %s;\n",
      Json(VOXDAG_VERSION).dump().c_str());
  for (const auto& [name, constants] : groups.items())
    std::printf("export const %s = %s;\n", name.c_str(), constants.dump(2).c_str());
  std::printf("/** The numbers above as GLSL: DAG.leafLevels is DAG_LEAF_LEVELS. */\n");
  std::printf("export const GLSL = %s;\n", Json(glsl_definitions(groups)).dump().c_str());
}

}  // namespace
}  // namespace voxdag

int main() {
  voxdag::print_module();
  return std::fflush(stdout) == 0 ? 0 : 1;
}
