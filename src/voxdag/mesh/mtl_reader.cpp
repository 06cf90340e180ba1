#include "voxdag/mesh/mtl_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "voxdag/image/color.hpp"
#include "voxdag/mesh/obj_lines.hpp"

namespace voxdag {
namespace {

std::string to_lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}

/// The numbers that the text starts with, `most` at most, taken off it; the others stay as given.
void take_numbers(std::string_view& text, std::span<float> numbers) {
  for (float& number : numbers) {
    std::string_view rest = text;
    float value = 0;
    if (!parse_float(next_token(rest), value) || !std::isfinite(value)) return;
    number = value;
    text = rest;
  }
}

/// A map statement: its options and its file.
struct Map {
  std::string file;
  std::array<float, 3> scale{1, 1, 1}, offset{0, 0, 0};
  std::array<float, 2> base_gain{0, 1};
  float bump = 1;
  bool clamp = false;
};

Map parse_map(std::string_view text) {
  Map map;
  for (text = trim(text); text.starts_with('-'); text = trim(text)) {
    std::string_view rest = text;
    const std::string option = to_lower(next_token(rest));
    const auto switch_value = [&] { return to_lower(next_token(rest)) == "on"; };
    std::array<float, 3> ignored{};
    if (option == "-s")
      take_numbers(rest, map.scale);
    else if (option == "-o")
      take_numbers(rest, map.offset);
    else if (option == "-mm")
      take_numbers(rest, map.base_gain);
    else if (option == "-bm")
      take_numbers(rest, std::span(&map.bump, 1));
    else if (option == "-clamp")
      map.clamp = switch_value();
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
  return map;
}

class MtlReader {
 public:
  MtlReader(const std::filesystem::path& folder, Appearance& appearance)
      : folder_(folder), appearance_(appearance) {
    for (std::size_t i = 0; i < appearance.images.size(); ++i)
      images_.emplace(appearance.images[i].path.string(), static_cast<int>(i));
  }

  std::vector<std::string> read(std::string_view text) {
    text = without_byte_order_mark(text);
    for_each_line(text, line_end_of(text), [this](std::string_view line, const char*) {
      const std::string keyword = to_lower(next_token(line));
      if (keyword == "newmtl")
        start(trim(line));
      else if (material_ != nullptr)
        take(keyword, line);
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

  void take(const std::string& keyword, std::string_view line) {
    Material& material = *material_;
    if (keyword == "kd") {
      std::array<float, 3> kd{-1, -1, -1};
      take_numbers(line, kd);
      if (kd[0] < 0) return;  // "Kd spectral FILE", "Kd xyz ...", or nothing.
      for (std::size_t c = 1; c < 3; ++c)
        if (kd[c] < 0) kd[c] = kd[0];
      for (int c = 0; c < 3; ++c)
        material.base_color[c] =
            srgb_to_linear(std::clamp(kd[static_cast<std::size_t>(c)], 0.0f, 1.0f));
    } else if (keyword == "d" || keyword == "tr") {
      if (trim(line).starts_with("-halo")) next_token(line);
      float value = keyword == "d" ? 1.0f : 0.0f;
      take_numbers(line, std::span(&value, 1));
      material.alpha = std::clamp(keyword == "d" ? value : 1 - value, 0.0f, 1.0f);
      if (material.alpha < 1 && material.alpha_mode == AlphaMode::kOpaque)
        material.alpha_mode = AlphaMode::kBlend;
    } else if (keyword == "map_kd") {
      material.color_map = use(parse_map(line));
    } else if (keyword == "map_d") {
      material.alpha_map = use(parse_map(line));
      if (material.alpha_map.exists()) material.alpha_mode = AlphaMode::kMask;
    } else if (keyword == "norm" || keyword == "map_kn") {
      set_normal_map(parse_map(line), NormalMapKind::kTangentSpace);
    } else if (keyword == "bump" || keyword == "map_bump") {
      if (material.normal_map.exists() && material.normal_kind == NormalMapKind::kTangentSpace)
        return;  // `norm` says more.
      set_normal_map(parse_map(line), NormalMapKind::kEither);
    } else if (keyword == "disp" || keyword == "map_disp") {
      const Map map = parse_map(line);
      material.displacement_map = use(map);
      material.displacement_base = map.base_gain[0];
      material.displacement_gain = map.base_gain[1];
    }
  }

  void set_normal_map(const Map& map, NormalMapKind kind) {
    material_->normal_map = use(map);
    material_->normal_kind = kind;
    material_->normal_scale = map.bump;
  }

  TextureUse use(const Map& map) {
    TextureUse use;
    if (map.file.empty()) return use;
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

  const std::filesystem::path& folder_;
  Appearance& appearance_;
  std::map<std::string, int> images_;
  Material* material_ = nullptr;
  std::vector<std::string> described_;
};

}  // namespace

std::vector<std::string> read_mtl(std::string_view text, const std::filesystem::path& folder,
                                  Appearance& appearance) {
  return MtlReader(folder, appearance).read(text);
}

}  // namespace voxdag
