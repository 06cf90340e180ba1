#include "voxdag/render/film/view_settings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>

#include "voxdag/render/film/environment_json.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kMaxBytes = std::uint64_t{16} << 20;
constexpr int kVersion = 1;
constexpr std::size_t kMaxTextBytes = 8000;

/// Reads the settings. `key` is the whole key of a value, such as "sun.angle".
class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file) {}

  ViewSettings read(const Json& json) {
    RenderOptions& options = settings_.options;
    options.ground = true;
    options.section.hatch = true;
    each_member(
        json, "",
        {{"version", [&](const Json& value) { check_version(value); }},
         {"camera", [&](const Json& value) { read_camera(value); }},
         {"sun", [&](const Json& value) { read_sun(value); }},
         {"sky",
          [&](const Json& value) { options.sky = real(value, "sky", 0, RenderLimits::kSky); }},
         {"environment", [&](const Json& value) { read_environment(value); }},
         {"bounces", [&](const Json& value) { read_bounces(value); }},
         {"exposure",
          [&](const Json& value) { options.exposure = real(value, "exposure", 0, 1e30); }},
         {"tone", [&](const Json& value) { options.tone = tone(value); }},
         {"background", [&](const Json& value) { options.background = background(value); }},
         {"ground", [&](const Json& value) { options.ground = flag(value, "ground"); }},
         {"shadows", [&](const Json& value) { options.shadows = flag(value, "shadows"); }},
         {"occlusion", [&](const Json& value) { read_occlusion(value); }},
         {"lod",
          [&](const Json& value) {
            options.lod_pixels = real(value, "lod", 0, RenderLimits::kLodPixels);
          }},
         {"cubes",
          [&](const Json& value) {
            options.cube_pixels = real(value, "cubes", 0, RenderLimits::kCubePixels);
          }},
         {"level",
          [&](const Json& value) {
            if (!value.is_null()) ignore("level", "a picture shows the finest level");
          }},
         {"colors", [&](const Json& value) { settings_.colors = flag(value, "colors"); }},
         {"normals", [&](const Json& value) { settings_.normals = flag(value, "normals"); }},
         {"hidden",
          [&](const Json& value) {
            each_element(value, "hidden",
                         [&](auto& one, const auto& key) { whole(one, key, 0, 65534); });
            if (!value.empty()) ignore("hidden", "a picture shows all materials");
          }},
         {"show",
          [&](const Json& value) {
            if (value != "light") ignore("show", "a picture shows the light; --pass writes others");
          }},
         {"channel", [&](const Json& value) { read_channel(value); }},
         {"section", [&](const Json& value) { read_section(value); }},
         {"mode",
          [&](const Json& value) {
            one_of(value, "mode", {"orbit", "fly", "walk"});
          }},
         {"title", [&](const Json& value) { settings_.title = text(value, "title"); }},
         {"licence", [&](const Json& value) { settings_.licence = text(value, "licence"); }},
         {"unit",
          [&](const Json& value) {
            if (!value.is_null()) one_of(value, "unit", {"m", "cm", "mm", "in", "ft"});
          }},
         {"measures",
          [&](const Json& value) {
            each_element(value, "measures",
                         [&](auto& one, const auto& key) { check_measure(one, key); });
          }},
         {"annotations",
          [&](const Json& value) {
            each_element(value, "annotations",
                         [&](auto& one, const auto& key) { check_note(one, key); });
          }},
         {"path", [&](const Json& value) {
            each_element(value, "path",
                         [&](auto& one, const auto& key) { check_path_key(one, key); });
          }}});
    if (options.bounces && options.occlusion_samples == 0) {
      ignore("bounces", "it needs \"occlusion.samples\" of at least 1");
      options.bounces.reset();
    }
    return std::move(settings_);
  }

 private:
  using Members = std::map<std::string, std::function<void(const Json&)>>;

  [[noreturn]] void refuse(const std::string& key, const std::string& reason) const {
    throw Error(file_, "", key.empty() ? reason : "\"" + key + "\" " + reason);
  }
  void ignore(const std::string& key, const std::string& why) {
    settings_.ignored.push_back("\"" + key + "\" is ignored: " + why);
  }

  /// Calls the function of each member of an object, whose key is `key`.
  void each_member(const Json& json, const std::string& key, const Members& members) {
    if (!json.is_object()) refuse(key, key.empty() ? "must be an object" : "is not an object");
    for (const auto& [name, value] : json.items()) {
      const auto member = members.find(name);
      if (member != members.end()) {
        member->second(value);
        continue;
      }
      settings_.unknown.push_back((key.empty() ? "" : key + ".") + name);
      ignore(settings_.unknown.back(), "the key is unknown");
    }
  }
  /// Calls check(element, key of the element) for each element of an array.
  template <class Check>
  void each_element(const Json& json, const std::string& key, const Check& check) const {
    if (!json.is_array()) refuse(key, "is not an array");
    for (std::size_t i = 0; i < json.size(); ++i) check(json[i], fmt::format("{}[{}]", key, i));
  }
  void need(const Json& json, const std::string& key, std::vector<const char*> all) const {
    for (const char* const name : all)
      if (!json.contains(name)) refuse(key + "." + name, "is missing");
  }

  double number(const Json& json, const std::string& key, double least, double most) const {
    const double value = json_number(json, {file_, ""}, key);
    if (!(value >= least && value <= most))
      refuse(key, fmt::format("is {}; allowed are {} to {}", value, least, most));
    return value;
  }
  int whole(const Json& json, const std::string& key, int least, int most) const {
    const double value = number(json, key, least, most);
    if (value != std::floor(value)) refuse(key, "is not a whole number");
    return static_cast<int>(value);
  }
  float real(const Json& json, const std::string& key, double least, double most) const {
    return static_cast<float>(number(json, key, least, most));
  }
  Vec3d vector(const Json& json, const std::string& key) const {
    return json_vector(json, {file_, ""}, key);
  }
  Vec3d direction(const Json& json, const std::string& key) const {
    return json_direction(json, {file_, ""}, key);
  }
  bool flag(const Json& json, const std::string& key) const {
    if (!json.is_boolean()) refuse(key, "is not true or false");
    return json.get<bool>();
  }

  std::string text(const Json& json, const std::string& key) const {
    if (!json.is_string()) refuse(key, "is not a text");
    auto text = json.get<std::string>();
    if (text.size() > kMaxTextBytes)
      refuse(key, fmt::format("has more than {} bytes", kMaxTextBytes));
    return text;
  }
  void one_of(const Json& json, const std::string& key,
              std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
      if (json == name) return;
    refuse(key, fmt::format("is none of {}", fmt::join(names, ", ")));
  }

  ToneMap tone(const Json& json) const {
    if (json == "neutral") return ToneMap::kNeutral;
    if (json == "agx") return ToneMap::kAgx;
    if (json != "filmic") refuse("tone", "is none of neutral, agx and filmic");
    return ToneMap::kFilmic;
  }

  Background background(const Json& json) const {
    if (json == "grey") return Background::kGrey;
    if (json == "white") return Background::kWhite;
    if (json == "black") return Background::kBlack;
    if (json != "sky") refuse("background", "is none of sky, grey, white and black");
    return Background::kSky;
  }

  void check_version(const Json& json) const {
    if (json != kVersion)
      refuse("version", fmt::format("is {}; this program reads version {}", json.dump(), kVersion));
  }

  void read_camera(const Json& json) {
    if (json.is_null()) return;
    ViewRequest& view = settings_.options.view;
    view.up = View{}.up;
    view.vertical_fov_degrees = View{}.vertical_fov_degrees;
    each_member(
        json, "camera",
        {{"eye", [&](const Json& value) { view.eye = vector(value, "camera.eye"); }},
         {"target", [&](const Json& value) { view.target = vector(value, "camera.target"); }},
         {"up", [&](const Json& value) { view.up = direction(value, "camera.up"); }},
         {"fov", [&](const Json& value) {
            view.vertical_fov_degrees = number(value, "camera.fov", kMinFovDegrees, 179);
          }}});
    if (!view.eye) refuse("camera.eye", "is missing");
    if (!view.target) refuse("camera.target", "is missing");
    const Vec3d forward = *view.target - *view.eye;
    if (!(length(forward) > 0)) refuse("camera", "has eye and target at one point");
    if (!(length(cross(normalized(forward), normalized(*view.up))) > 1e-6))
      refuse("camera.up", "points along the view");
  }

  void read_sun(const Json& json) {
    RenderOptions& options = settings_.options;
    each_member(json, "sun",
                {{"direction",
                  [&](const Json& value) {
                    if (!value.is_null()) options.sun = direction(value, "sun.direction");
                  }},
                 {"angle",
                  [&](const Json& value) {
                    options.sun_degrees = number(value, "sun.angle", 0, RenderLimits::kSunDegrees);
                  }},
                 {"on", [&](const Json& value) { options.with_sun = flag(value, "sun.on"); }}});
  }

  void read_environment(const Json& json) {
    RenderOptions& options = settings_.options;
    each_member(json, "environment",
                {{"map",
                  [&](const Json& value) {
                    if (!value.is_null())
                      options.environment = environment_of_json(value, {file_, ""});
                  }},
                 {"turn", [&](const Json& value) {
                    options.environment_degrees = number(value, "environment.turn", -360, 360);
                  }}});
  }

  void read_bounces(const Json& json) {
    if (!json.is_null())
      settings_.options.bounces = whole(json, "bounces", 0, RenderLimits::kBounces);
  }

  void read_occlusion(const Json& json) {
    RenderOptions& options = settings_.options;
    each_member(json, "occlusion",
                {{"samples",
                  [&](const Json& value) {
                    options.occlusion_samples =
                        whole(value, "occlusion.samples", 0, RenderLimits::kOcclusionSamples);
                  }},
                 {"distance",
                  [&](const Json& value) {
                    options.occlusion_distance = number(value, "occlusion.distance", 0, 1e30);
                  }},
                 {"cone", [&](const Json& value) {
                    options.occlusion_cone =
                        number(value, "occlusion.cone", 0, RenderLimits::kOcclusionCone);
                  }}});
  }

  void read_channel(const Json& json) {
    each_member(
        json, "channel",
        {{"name", [&](const Json& value) { settings_.channel = text(value, "channel.name"); }},
         {"range", [&](const Json& value) {
            if (value.is_null()) return;
            const auto refuse_it = [&] {
              refuse(
                  "channel.range",
                  "is not an array of two numbers in the range of floats, the smaller one first");
            };
            if (!value.is_array() || value.size() != 2 || !value[0].is_number() ||
                !value[1].is_number())
              refuse_it();
            const ChannelRange range{value[0].get<double>(), value[1].get<double>()};
            const ChannelRange floats = range_of(ChannelKind::kF32);
            if (!(range.least < range.most) || range.least < floats.least ||
                range.most > floats.most)
              refuse_it();
            settings_.channel_range = range;
          }}});
  }

  void read_section(const Json& json) {
    SectionOptions& section = settings_.options.section;
    each_member(
        json, "section",
        {{"box",
          [&](const Json& value) {
            if (!value.is_null()) section.box = read_box(value, "section.box");
          }},
         {"hatch", [&](const Json& value) { section.hatch = flag(value, "section.hatch"); }},
         {"plane", [&](const Json& value) {
            if (!value.is_null()) section.plane = read_plane(value, "section.plane");
          }}});
  }

  void check_measure(const Json& json, const std::string& key) {
    const auto point = [&](const char* name) {
      return [this, name, &key](const Json& value) { vector(value, key + "." + name); };
    };
    each_member(json, key,
                {{"from", point("from")},
                 {"to", point("to")},
                 {"kind",
                  [&](const Json& value) {
                    one_of(value, key + ".kind", {"distance", "path", "area", "angle", "height"});
                  }},
                 {"points", [&](const Json& value) {
                    each_element(value, key + ".points",
                                 [&](auto& one, const auto& name) { vector(one, name); });
                    if (value.size() < 2) refuse(key + ".points", "has less than 2 points");
                  }}});
    if (!json.contains("points")) need(json, key, {"from", "to"});
  }

  void check_note(const Json& json, const std::string& key) {
    each_member(json, key,
                {{"text", [&](const Json& value) { text(value, key + ".text"); }},
                 {"point", [&](const Json& value) { vector(value, key + ".point"); }},
                 {"camera", [&](const Json& value) { check_camera(value, key + ".camera"); }}});
    need(json, key, {"text", "point", "camera"});
  }

  /// Checks the members of a camera, and `time` of one that is a key of a path.
  void check_camera(const Json& json, const std::string& key, bool has_time = false) {
    Members members = {
        {"eye", [&](const Json& value) { vector(value, key + ".eye"); }},
        {"target", [&](const Json& value) { vector(value, key + ".target"); }},
        {"up", [&](const Json& value) { direction(value, key + ".up"); }},
        {"fov", [&](const Json& value) { number(value, key + ".fov", kMinFovDegrees, 179); }}};
    if (has_time)
      members["time"] = [&](const Json& value) { number(value, key + ".time", -1e9, 1e9); };
    each_member(json, key, members);
    need(json, key, {"eye", "target"});
  }

  void check_path_key(const Json& json, const std::string& key) {
    check_camera(json, key, true);
    need(json, key, {"time"});
  }

  Box3d read_box(const Json& json, const std::string& key) {
    std::optional<Vec3d> low, high;
    each_member(json, key,
                {{"low", [&](const Json& value) { low = vector(value, key + ".low"); }},
                 {"high", [&](const Json& value) { high = vector(value, key + ".high"); }}});
    if (!low) refuse(key + ".low", "is missing");
    if (!high) refuse(key + ".high", "is missing");
    for (int axis = 0; axis < 3; ++axis)
      if (!((*low)[axis] <= (*high)[axis])) refuse(key, "has its low corner above its high one");
    return {*low, *high};
  }

  SectionOptions::Plane read_plane(const Json& json, const std::string& key) {
    std::optional<Vec3d> point, normal;
    each_member(
        json, key,
        {{"point", [&](const Json& value) { point = vector(value, key + ".point"); }},
         {"normal", [&](const Json& value) { normal = direction(value, key + ".normal"); }}});
    if (!point) refuse(key + ".point", "is missing");
    if (!normal) refuse(key + ".normal", "is missing");
    return {*point, *normal};
  }

  const std::string& file_;
  ViewSettings settings_;
};

}  // namespace

ViewSettings read_view_settings(const std::string& file) {
  return Reader(file).read(read_json_file(file, {kMaxBytes, "a view"}));
}

ViewSettings parse_view_settings(const std::string& text, const std::string& name) {
  return Reader(name).read(Json::parse(text));
}

}  // namespace voxdag
