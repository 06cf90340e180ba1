#include "voxdag/readers/obj/mtl_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>

#include "voxdag/image/color.hpp"
#include "voxdag/readers/obj/obj_lines.hpp"

namespace voxdag {
namespace {

std::string to_lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}

/// A statement that is not what it should be; the message is the reason.
struct Malformed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Takes the numbers that the text starts with off it, `numbers.size()` at most, and returns how
/// many there were. Those that are not finite are taken, too: nothing else begins like that.
std::size_t take_numbers(std::string_view& text, std::span<float> numbers) {
  std::size_t count = 0;
  std::string_view rest = text;
  for (float number; count < numbers.size() && parse_float(next_token(rest), number); text = rest)
    numbers[count++] = number;
  return count;
}

bool all_finite(std::span<const float> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); });
}

/// The same where there must be at least so many, all finite; the others stay as given.
void take_numbers(std::string_view& text, std::span<float> numbers, std::size_t least,
                  const char* expected) {
  const std::size_t count = take_numbers(text, numbers);
  if (count < least || !all_finite(numbers.first(count))) throw Malformed(expected);
}

/// A map statement: its options and its file.
struct Map {
  std::string file;
  std::array<float, 3> scale{1, 1, 1}, offset{0, 0, 0};
  std::array<float, 2> base_gain{0, 1};
  float bump = 1;
  bool clamp = false;
};

bool take_switch(std::string_view& text) {
  const std::string value = to_lower(next_token(text));
  if (value != "on" && value != "off") throw Malformed("-clamp takes on or off");
  return value == "on";
}

/// Throws Malformed.
Map parse_map(std::string_view text) {
  Map map;
  for (text = trim(text); text.starts_with('-'); text = trim(text)) {
    std::string_view rest = text;
    const std::string option = to_lower(next_token(rest));
    std::array<float, 3> ignored{};
    if (option == "-s")
      take_numbers(rest, map.scale, 1, "-s takes one to three finite numbers");
    else if (option == "-o")
      take_numbers(rest, map.offset, 1, "-o takes one to three finite numbers");
    else if (option == "-mm")
      take_numbers(rest, map.base_gain, 2, "-mm takes two finite numbers");
    else if (option == "-bm")
      take_numbers(rest, std::span(&map.bump, 1), 1, "-bm takes a finite number");
    else if (option == "-clamp")
      map.clamp = take_switch(rest);
    else if (option == "-t")
      take_numbers(rest, ignored);
    else if (option == "-boost" || option == "-texres")
      take_numbers(rest, std::span(ignored).first(1));
    else if (option == "-blendu" || option == "-blendv" || option == "-cc" ||
             option == "-imfchan" || option == "-type")
      next_token(rest);
    else
      break;  // A file whose name starts with a dash.
    text = rest;
  }
  map.file = text;
  if (map.file.empty()) throw Malformed("it names no file");
  return map;
}

class MtlReader {
 public:
  MtlReader(const std::filesystem::path& file, Appearance& appearance,
            std::vector<std::string>& warnings)
      : file_(file), folder_(file.parent_path()), appearance_(appearance), warnings_(warnings) {
    for (std::size_t i = 0; i < appearance.images.size(); ++i)
      images_.emplace(appearance.images[i].path.string(), static_cast<int>(i));
  }

  std::vector<std::string> read(std::string_view text) {
    text = without_byte_order_mark(text);
    const char line_end = line_end_of(text);
    for_each_line(text, line_end, [&](std::string_view line, const char* position) {
      const std::string_view whole = trim(line);
      const std::string keyword = to_lower(next_token(line));
      if (keyword == "newmtl") return start(trim(line));
      if (material_ == nullptr) return;
      const auto warn = [&](const std::string& what) {
        const auto number = 1 + std::count(text.data(), position, line_end);
        warnings_.push_back(file_.string() + ": line " + std::to_string(number) + ": " +
                            in_quotes(whole) + ": " + what);
      };
      take(keyword, trim(line), warn);
    });
    return std::move(described_);
  }

 private:
  void start(std::string_view name) {
    const auto found =
        std::find_if(appearance_.materials.begin(), appearance_.materials.end(),
                     [&](const Material& material) { return material.name == name; });
    material_ = found == appearance_.materials.end() ? nullptr : &*found;
    if (material_ == nullptr) return;
    *material_ = {};
    material_->name = name;
    described_.emplace_back(name);
  }

  /// warn(what is wrong and what stands in) is called for what is malformed.
  template <class Warn>
  void take(const std::string& keyword, std::string_view line, const Warn& warn) {
    Material& material = *material_;
    // What stands in for what is malformed is set before.
    const auto attempt = [&](const char* stands_in, const auto& body) {
      try {
        body();
      } catch (const Malformed& fault) {
        warn(std::string(fault.what()) + ": " + stands_in);
      }
    };
    if (keyword == "kd") {
      material.base_color = kDefaultColor;
      attempt("the material's colour is grey", [&] { set_color(line, warn); });
    } else if (keyword == "d" || keyword == "tr") {
      material.alpha = 1;
      attempt("the material is opaque", [&] { set_alpha(line, keyword == "tr", warn); });
      if (material.alpha < 1 && material.alpha_mode == AlphaMode::kOpaque)
        material.alpha_mode = AlphaMode::kBlend;
    } else if (keyword == "map_kd") {
      material.color_map = {};
      attempt("the material's colour stands in for the texture",
              [&] { material.color_map = use(parse_map(line)); });
    } else if (keyword == "map_d") {
      material.alpha_map = {};
      attempt("the material is opaque without its alpha map", [&] {
        material.alpha_map = use(parse_map(line));
        material.alpha_mode = AlphaMode::kMask;
      });
    } else if (keyword == "norm" || keyword == "map_kn") {
      set_normal_map(line, NormalMapKind::kTangentSpace, attempt);
    } else if (keyword == "bump" || keyword == "map_bump") {
      if (material.normal_map.exists() && material.normal_kind == NormalMapKind::kTangentSpace)
        return;  // `norm` says more.
      set_normal_map(line, NormalMapKind::kEither, attempt);
    } else if (keyword == "disp" || keyword == "map_disp") {
      material.displacement_map = {};
      attempt("the surface stays without displacement", [&] {
        const Map map = parse_map(line);
        material.displacement_map = use(map);
        material.displacement_base = map.base_gain[0];
        material.displacement_gain = map.base_gain[1];
      });
    }
  }

  template <class Warn>
  void set_color(std::string_view line, const Warn& warn) {
    std::string_view rest = line;
    if (const std::string kind = to_lower(next_token(rest)); kind == "spectral" || kind == "xyz")
      throw Malformed("spectral curves and CIEXYZ are not read");
    std::array<float, 3> kd{};
    const std::size_t count = take_numbers(line, kd);
    // One is for all three.
    const bool is_grey = count == 1 && next_corner(line).empty();
    if (is_grey) kd[1] = kd[2] = kd[0];
    if ((count != 3 && !is_grey) || !all_finite(kd)) throw Malformed(kColorNumbers);
    for (std::size_t c = 0; c < 3; ++c)
      material_->base_color[static_cast<int>(c)] = srgb_to_linear(std::clamp(kd[c], 0.0f, 1.0f));
    if (std::any_of(kd.begin(), kd.end(), is_outside)) warn(kClamped);
  }

  template <class Warn>
  void set_alpha(std::string_view line, bool is_transparency, const Warn& warn) {
    if (line.starts_with("-halo")) next_token(line);
    float value = 0;
    take_numbers(line, std::span(&value, 1), 1, "not a finite number");
    material_->alpha = std::clamp(is_transparency ? 1 - value : value, 0.0f, 1.0f);
    if (is_outside(value)) warn(kClamped);
  }

  template <class Attempt>
  void set_normal_map(std::string_view line, NormalMapKind kind, const Attempt& attempt) {
    material_->normal_map = {};
    attempt("the mesh's own normals stand in for the normal map", [&] {
      const Map map = parse_map(line);
      material_->normal_map = use(map);
      material_->normal_kind = kind;
      material_->normal_scale = map.bump;
    });
  }

  TextureUse use(const Map& map) {
    TextureUse use;
    std::string file = map.file;
    std::replace(file.begin(), file.end(), '\\', '/');  // Written on Windows.
    const std::filesystem::path path = folder_ / file;
    const auto [known, is_new] =
        images_.try_emplace(path.string(), static_cast<int>(appearance_.images.size()));
    if (is_new) appearance_.images.push_back({path.string(), path, {}});
    use.image = known->second;
    if (map.clamp) use.wrap_u = use.wrap_v = TextureWrap::kClamp;
    // The file's v runs up and ours, 1 - v, down: s * v + o becomes s * (1 - v) + (1 - s - o).
    use.uv = {map.scale[0], 0, 0, map.scale[1], map.offset[0], 1 - map.scale[1] - map.offset[1]};
    return use;
  }

  static constexpr const char* kColorNumbers = "not one or three finite numbers";
  static constexpr const char* kClamped = "outside of 0 to 1: it is clamped";
  static bool is_outside(float value) { return value < 0 || value > 1; }

  const std::filesystem::path& file_;
  const std::filesystem::path folder_;
  Appearance& appearance_;
  std::vector<std::string>& warnings_;
  std::map<std::string, int> images_;
  Material* material_ = nullptr;
  std::vector<std::string> described_;
};

}  // namespace

std::vector<std::string> read_mtl(std::string_view text, const std::filesystem::path& file,
                                  Appearance& appearance, std::vector<std::string>& warnings) {
  return MtlReader(file, appearance, warnings).read(text);
}

}  // namespace voxdag
