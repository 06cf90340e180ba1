/// Prints the JavaScript module constants.js: the numbers that the page shares with the library,
/// taken from its headers. The build runs it.
#include <cctype>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/render/exposure.hpp"
#include "voxdag/render/hatch.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/render/stored_look.hpp"
#include "voxdag/render/surface_normal.hpp"
#include "voxdag/render/surface_point.hpp"
#include "voxdag/render/tone_map.hpp"
#include "voxdag/stored/attributes/channel_colors.hpp"
#include "voxdag/stored/attributes/channels.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json json_of(T value) {
  return value;
}
template <class T>
Json json_of(Vec3<T> v) {
  return Json::array({v.x, v.y, v.z});
}

/// Returns the name in JavaScript: "chunkCount" for "chunk_count", "outlineCosine" for
/// "kOutlineCosine".
std::string camel_case(std::string name) {
  if (name.size() > 1 && name[0] == 'k' && std::isupper(static_cast<unsigned char>(name[1])) != 0) {
    name.erase(0, 1);
    name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  }
  for (std::size_t at; (at = name.find('_')) != name.npos;) {
    name.erase(at, 1);
    name[at] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[at])));
  }
  return name;
}

// Each makes a pair of the name in JavaScript and the value.
#define VOXDAG_OFFSET(type, member) \
  { camel_case(#member), offsetof(type, member) }
#define VOXDAG_CONSTANT(type, name) \
  { camel_case(#name), json_of(type::name) }
#define VOXDAG_MEMBER(object, member) \
  { camel_case(#member), json_of(object.member) }

/// The container of .vdag files; offsets are in bytes.
Json file_constants() {
  Json ids;
  for (const std::uint32_t id :
       {kChunkMeta, kChunkLevels, kChunkNodes, kChunkLeafBlocks, kChunkCompactHead,
        kChunkCompactStream, kChunkEsvo, kChunkEsvoBlocks, kChunkCellIndex, kChunkColors,
        kChunkNormals, kChunkWireColors, kChunkWireNormals})
    ids[vdag_chunk_name(id)] = id;
  return {{"magic", kVdagMagic},
          {"version", kVdagVersion},
          {"alignment", kVdagAlignment},
          {"maxChunks", kVdagMaxChunks},
          {"maxMetadataBytes", kVdagMaxMetadataBytes},
          {"requiredFlag", kVdagChunkRequired},
          {"headerBytes", sizeof(VdagHeader)},
          {"header",
           {VOXDAG_OFFSET(VdagHeader, version), VOXDAG_OFFSET(VdagHeader, chunk_count),
            VOXDAG_OFFSET(VdagHeader, file_bytes), VOXDAG_OFFSET(VdagHeader, checksum),
            VOXDAG_OFFSET(VdagHeader, reserved)}},
          {"chunkEntryBytes", sizeof(VdagChunkEntry)},
          {"chunkEntry",
           {VOXDAG_OFFSET(VdagChunkEntry, id), VOXDAG_OFFSET(VdagChunkEntry, flags),
            VOXDAG_OFFSET(VdagChunkEntry, offset), VOXDAG_OFFSET(VdagChunkEntry, length),
            VOXDAG_OFFSET(VdagChunkEntry, checksum)}},
          {"ids", ids}};
}

/// The stored words of a DAG's colours and normals; offsets are in bytes.
Json pages_constants() {
  Json channel_bits = Json::array(), units = Json::array(), length_bits = Json::array();
  for (int code = 0; code <= PagePrecision::kMaxCode; ++code) {
    const PagePrecision precision{code};
    channel_bits.push_back(
        {precision.channel_bits(0), precision.channel_bits(1), precision.channel_bits(2)});
    units.push_back(precision.unit());
    length_bits.push_back(precision.length_bits());
  }
  return {{"headerBytes", sizeof(ValuePagesHeader)},
          VOXDAG_OFFSET(ValuePagesHeader, precision),
          VOXDAG_OFFSET(ValuePagesHeader, values),
          VOXDAG_OFFSET(ValuePagesHeader, words),
          {"pageValues", kPageValues},
          {"groupPages", kGroupPages},
          {"units", units},
          {"lengthBits", length_bits},
          VOXDAG_CONSTANT(ValueBlock, kTypeBits),
          VOXDAG_CONSTANT(ValueBlock, kStepBits),
          VOXDAG_CONSTANT(ValueBlock, kStepUnit),
          {"flat", static_cast<int>(ValueBlock::kFlat)},
          {"raw", static_cast<int>(ValueBlock::kRaw)},
          {"channelBits", channel_bits}};
}

/// The chunk CHAN, whose offsets are in bytes, and the colours of channels.
Json channel_constants() {
  Json kinds = Json::array(), colors = Json::array();
  for (std::uint32_t kind = 0; kind < kChannelKinds; ++kind)
    kinds.push_back(name_of(static_cast<ChannelKind>(kind)));
  for (const Value8& color : kColorMap) colors.push_back({color.x, color.y, color.z});
  return {{"most", kMaxChannels},
          {"headerBytes", sizeof(ChannelsHeader)},
          VOXDAG_OFFSET(ChannelsHeader, channels),
          VOXDAG_OFFSET(ChannelsHeader, values),
          {"entryBytes", sizeof(ChannelEntry)},
          {"nameBytes", sizeof(ChannelEntry::name)},
          VOXDAG_OFFSET(ChannelEntry, kind),
          VOXDAG_OFFSET(ChannelEntry, bound),
          VOXDAG_OFFSET(ChannelEntry, words),
          {"kinds", kinds},
          {"blockValues", kChannelBlockValues},
          VOXDAG_CONSTANT(ChannelBlock, kMaxWidth),
          {"colors", colors}};
}

/// The wire form of values. Contexts count bits.
Json wire_constants() {
  return {{"headerBytes", sizeof(WireHeader)},
          {"precision", offsetof(WireHeader, parameter)},
          VOXDAG_OFFSET(WireHeader, values),
          VOXDAG_OFFSET(WireHeader, words),
          VOXDAG_OFFSET(WireHeader, coded_bytes),
          {"maxExpansion", kMaxWireExpansion},
          {"segmentPages", wire::kSegmentPages},
          VOXDAG_CONSTANT(wire::RangeCoder, kProbabilityBits),
          VOXDAG_CONSTANT(wire::RangeCoder, kMinRange),
          VOXDAG_CONSTANT(wire::AdaptiveBit, kFast),
          VOXDAG_CONSTANT(wire::AdaptiveBit, kSlow),
          {"model",
           {VOXDAG_CONSTANT(wire::ValueModelSizes, kTypes),
            VOXDAG_CONSTANT(wire::ValueModelSizes, kLengthBits),
            VOXDAG_CONSTANT(wire::ValueModelSizes, kLengthContexts),
            VOXDAG_CONSTANT(wire::ValueModelSizes, kEndBits),
            VOXDAG_CONSTANT(wire::ValueModelSizes, kEndContexts),
            VOXDAG_CONSTANT(wire::ValueModelSizes, kStepBits),
            VOXDAG_CONSTANT(wire::ValueModelSizes, kWeightBits),
            VOXDAG_CONSTANT(wire::ValueModelSizes, kNoWeight)}}};
}

/// The light, and the options of a picture whose defaults the page shares.
Json light_constants() {
  const Sky sky;
  const RenderOptions options;
  return {VOXDAG_MEMBER(sky, sun_light),
          VOXDAG_MEMBER(sky, zenith),
          VOXDAG_MEMBER(sky, horizon),
          VOXDAG_MEMBER(sky, ground),
          VOXDAG_CONSTANT(SkyShape, kGlow),
          {"groundSeen", SkyShape::kGround},
          VOXDAG_CONSTANT(SkyShape, kGroundBegins),
          VOXDAG_CONSTANT(SkyShape, kGroundIsFull),
          VOXDAG_CONSTANT(SkyShape, kHorizonInDome),
          VOXDAG_CONSTANT(SkyShape, kOpen),
          VOXDAG_CONSTANT(SkyShape, kFill),
          VOXDAG_CONSTANT(SkyShape, kFillFacing),
          VOXDAG_CONSTANT(SkyShape, kFillAside),
          {"defaultSun", json_of(kDefaultSun)},
          VOXDAG_MEMBER(options, sun_degrees),
          VOXDAG_MEMBER(options, sky),
          VOXDAG_MEMBER(options, shadow_samples),
          VOXDAG_MEMBER(options, occlusion_samples),
          {"occlusionDistance", kOcclusionDistance},
          {"interiorOcclusion", kInteriorOcclusion},
          VOXDAG_MEMBER(options, occlusion_cone),
          VOXDAG_MEMBER(options, lod_pixels),
          VOXDAG_MEMBER(options, cube_pixels),
          VOXDAG_MEMBER(options, albedo),
          {"grey", kGreyBackground},
          {"cutAlbedo", json_of(kCutAlbedo)},
          {"hatchWidth", kHatchWidth},
          {"hatchShade", kHatchShade},
          {"hatchPeriods", kHatchPeriods}};
}

/// Returns all groups of constants by name.
Json all_constants() {
  return {
      {"FILE", file_constants()},
      {"DAG",
       {{"minLevels", kMinLevels},
        {"maxLevels", kMaxLevels},
        {"leafLevels", 2},  // A leaf block is 4³ voxels.
        {"subvoxels", kSubvoxels}}},
      {"CELL_INDEX",
       {{"headerBytes", sizeof(CellIndexHeader)},
        VOXDAG_OFFSET(CellIndexHeader, finest_level),
        VOXDAG_OFFSET(CellIndexHeader, cells),
        VOXDAG_OFFSET(CellIndexHeader, width)}},
      {"PAGES", pages_constants()},
      {"CHANNELS", channel_constants()},
      {"WIRE", wire_constants()},
      {"SAMPLES",
       {VOXDAG_CONSTANT(SampleTables, kSets), VOXDAG_CONSTANT(SampleTables, kRotations)}},
      {"LIGHT", light_constants()},
      {"EXPOSURE",
       {VOXDAG_CONSTANT(ExposureRule, kMiddle), VOXDAG_CONSTANT(ExposureRule, kBright),
        VOXDAG_CONSTANT(ExposureRule, kWhite), VOXDAG_CONSTANT(ExposureRule, kMin),
        VOXDAG_CONSTANT(ExposureRule, kOfNothing), VOXDAG_CONSTANT(ExposureRule, kMost),
        VOXDAG_CONSTANT(ExposureRule, kSky), VOXDAG_CONSTANT(ExposureRule, kLuminance)}},
      {"TONE",
       {VOXDAG_CONSTANT(ToneCurve, kA), VOXDAG_CONSTANT(ToneCurve, kB),
        VOXDAG_CONSTANT(ToneCurve, kC), VOXDAG_CONSTANT(ToneCurve, kD),
        VOXDAG_CONSTANT(ToneCurve, kE)}},
      {"NEUTRAL",
       {VOXDAG_CONSTANT(NeutralCurve, kFloor), VOXDAG_CONSTANT(NeutralCurve, kStart),
        VOXDAG_CONSTANT(NeutralCurve, kDesaturation)}},
      {"AGX",
       {VOXDAG_CONSTANT(AgxCurve, kInRed), VOXDAG_CONSTANT(AgxCurve, kInGreen),
        VOXDAG_CONSTANT(AgxCurve, kInBlue), VOXDAG_CONSTANT(AgxCurve, kOutRed),
        VOXDAG_CONSTANT(AgxCurve, kOutGreen), VOXDAG_CONSTANT(AgxCurve, kOutBlue),
        VOXDAG_CONSTANT(AgxCurve, kLowest), VOXDAG_CONSTANT(AgxCurve, kHighest)}},
      {"NORMAL",
       {VOXDAG_CONSTANT(LayerRule, kRadius), VOXDAG_CONSTANT(LayerRule, kPower),
        VOXDAG_CONSTANT(LayerRule, kThin), VOXDAG_CONSTANT(LayerRule, kThick),
        VOXDAG_CONSTANT(LayerRule, kPlane), VOXDAG_CONSTANT(LayerRule, kEdge),
        VOXDAG_CONSTANT(LayerRule, kOutlineCosine), VOXDAG_CONSTANT(LayerRule, kCoarser),
        VOXDAG_CONSTANT(BackRule, kLeaning), VOXDAG_CONSTANT(BackRule, kOpposite)}},
      {"START",
       {VOXDAG_CONSTANT(StartRule, kSlack), VOXDAG_CONSTANT(StartRule, kHidden),
        VOXDAG_CONSTANT(StartRule, kTries), VOXDAG_CONSTANT(StartRule, kFarthest)}},
      {"VIEW", {{"minFovDegrees", kMinFovDegrees}, {"fovDegrees", View{}.vertical_fov_degrees}}}};
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
  for (const auto& [group, constants] : groups.items()) {
    // Shaders read none of these.
    if (group == "FILE" || group == "CELL_INDEX" || group == "CHANNELS" || group == "WIRE" ||
        group == "VIEW")
      continue;
    for (const auto& [name, value] : constants.items())
      if (const std::string glsl = glsl_value(value); !glsl.empty())
        text += "#define " + group + "_" + upper_snake(name) + " " + glsl + "\n";
  }
  return text;
}

void print_module() {
  const Json groups = all_constants();
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
