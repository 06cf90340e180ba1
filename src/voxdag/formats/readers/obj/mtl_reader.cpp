#include "voxdag/formats/readers/obj/mtl_reader.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/readers/name_table.hpp"
#include "voxdag/formats/readers/obj/mtl_map.hpp"
#include "voxdag/formats/readers/obj/obj_lines.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {

class MtlReader::Impl {
 public:
  Impl(const MeshSource& source, const NamedFiles& files, Appearance& appearance,
       Warnings& warnings)
      : source_(source),
        files_(files),
        appearance_(appearance),
        warnings_(warnings),
        names_(source.work().memory),
        plain_names_(source.work().memory),
        images_(source.work().memory),
        image_memory_(source.work().memory, 0),
        described_(appearance.materials.size(), Described::kNot) {
    for (const Material& material : appearance.materials) {
      const std::uint32_t id = names_.find_or_add(material.name);
      const std::string_view plain = plain_mtl_name(material.name);
      if (plain.size() < material.name.size() &&
          plain_names_.find_or_add(plain) == with_plain_name_.size())
        with_plain_name_.push_back(id);
    }
  }

  void read(std::string_view text, const std::filesystem::path& folder, const std::string& name) {
    folder_ = folder;
    file_ = name;
    material_ = nullptr;
    text = without_byte_order_mark(text);
    const char line_end = line_end_of(text);
    line_number_ = 1;
    const char* counted = text.data();
    CancelPoll poll(source_.work());
    for_each_line(
        text, line_end, source_.work().memory, [&](std::string_view line, const char* position) {
          poll.step();
          line_number_ += static_cast<std::size_t>(std::count(counted, position, line_end));
          counted = position;
          statement_ = trim(line);
          const std::string keyword = lower_case(next_token(line));
          if (keyword == "newmtl")
            start(trim(line));
          else if (material_ != nullptr)
            take(keyword, trim(line));
        });
    finish();
  }

  bool complete(std::size_t material) {
    if (described_[material] != Described::kNot) return true;
    Material& own = appearance_.materials[material];
    const auto other = find_plain(own.name);
    if (!other || described_[*other] == Described::kNot) return false;
    std::string name = std::move(own.name);
    own = appearance_.materials[*other];
    own.name = std::move(name);
    return true;
  }

 private:
  /// How a material is described: by a name that has to lose a comment or quotes, by one with which
  /// the material's own does without them, or by the same name. A stronger one replaces a weaker.
  enum class Described : std::uint8_t { kNot, kByPart, kByPlainName, kByName };

  /// Returns the material whose name is the given one without quotes and comment, or the first one
  /// whose name without them is.
  std::optional<std::uint32_t> find_plain(std::string_view name) const {
    const std::string_view plain = plain_mtl_name(name);
    if (const auto found = names_.find(plain)) return found;
    const auto found = plain_names_.find(plain);
    return found ? std::optional(with_plain_name_[*found]) : std::nullopt;
  }

  void start(std::string_view name) {
    finish();
    auto found = names_.find(name);
    const Described described = found                          ? Described::kByName
                                : plain_mtl_name(name) == name ? Described::kByPlainName
                                                               : Described::kByPart;
    if (!found) found = find_plain(name);
    if (!found || described < described_[*found]) return;
    material_ = &appearance_.materials[*found];
    *material_ = {};
    material_->name = names_[*found];
    described_[*found] = described;
    has_dissolve_ = false;
    hiding_.clear();
  }

  /// Ends the statements of the current material.
  void finish() {
    if (material_ == nullptr) return;
    Material& material = *material_;
    if (!has_dissolve_ && !hiding_.empty()) {
      material.alpha = 1;
      warnings_.add(hiding_ + ": it would hide the material: the material is opaque");
    }
    // A texture of emission without a colour counts in full.
    if (material.emission_map.exists() && material.emission == Vec3f{})
      material.emission = {1, 1, 1};
    material.alpha_mode = material.alpha_map.exists()   ? AlphaMode::kMask
                          : material.alpha < 1          ? AlphaMode::kBlend
                          : material.color_map.exists() ? AlphaMode::kImpliedMask
                                                        : AlphaMode::kOpaque;
    material_ = nullptr;
  }

  /// Adds a warning about the current statement, with its fault and its replacement.
  void warn(const std::string& what) { warnings_.add(statement_place() + ": " + what); }
  std::string statement_place() const {
    return file_ + ": " + ErrorPlace::line(line_number_).text() + ": " + in_quotes(statement_);
  }

  /// Runs body(), which parses a statement. If the statement is malformed, adds a warning that
  /// names `replacement`, the value that the caller has set before.
  template <class Body>
  void attempt(const char* replacement, const Body& body) {
    try {
      body();
    } catch (const MalformedMtl& fault) {
      warn(std::string(fault.what()) + ": " + replacement);
    } catch (const OverMemory&) {
      throw;
    } catch (const Error& fault) {  // of a file's name
      warn(fault.reason() + ": " + replacement);
    }
  }

  void take(const std::string& keyword, std::string_view line) {
    Material& material = *material_;
    if (keyword == "kd") {
      material.base_color = kDefaultColor;
      attempt("the material's colour is grey", [&] { set_color(line, material.base_color); });
    } else if (keyword == "ke") {
      material.emission = {};
      attempt("the material emits nothing", [&] { set_color(line, material.emission); });
    } else if (keyword == "map_ke") {
      material.emission_map = {};
      attempt("the material's emission has no texture",
              [&] { material.emission_map = use(map_of(line)); });
    } else if (keyword == "d" || (keyword == "tr" && !has_dissolve_)) {
      has_dissolve_ = keyword == "d";
      material.alpha = 1;
      attempt("the material is opaque", [&] { set_alpha(line, keyword == "tr"); });
      // Some programs write as Tr what is d.
      hiding_ = material.alpha < kBlendCutoff ? statement_place() : "";
    } else if (keyword == "map_kd") {
      material.color_map = {};
      attempt("the material's colour replaces the texture",
              [&] { material.color_map = use(map_of(line)); });
    } else if (keyword == "map_d") {
      material.alpha_map = {};
      attempt("the material is opaque without its alpha map",
              [&] { material.alpha_map = use(map_of(line)); });
    } else if (keyword == "norm" || keyword == "map_kn") {
      set_normal_map(line, NormalMapKind::kTangentSpace);
    } else if (keyword == "bump" || keyword == "map_bump") {
      if (material.normal_map.exists() && material.normal_kind == NormalMapKind::kTangentSpace)
        return;  // `norm` has one meaning; `bump` may be of either kind.
      set_normal_map(line, NormalMapKind::kEither);
    } else if (keyword == "pm" || keyword == "pr") {
      const bool is_metallic = keyword == "pm";
      float& value = is_metallic ? material.metallic_roughness.metallic
                                 : material.metallic_roughness.roughness;
      value = is_metallic ? 0 : 1;
      attempt(is_metallic ? "the material is no metal" : "the material is dull",
              [&] { set_fraction(line, value); });
    } else if (keyword == "map_pm" || keyword == "map_pr") {
      TextureUse& map = keyword == "map_pm" ? material.metallic_map : material.roughness_map;
      map = {};
      attempt("the material's number replaces the texture", [&] { map = use(map_of(line)); });
    } else if (keyword == "disp" || keyword == "map_disp") {
      material.displacement_map = {};
      attempt("the surface is not displaced", [&] {
        const MtlMap map = map_of(line);
        material.displacement_map = use(map);
        material.displacement_base = map.base_gain[0];
        material.displacement_gain = map.base_gain[1];
      });
    }
  }

  void set_color(std::string_view line, Vec3f& color) {
    std::string_view rest = line;
    if (const std::string kind = lower_case(next_token(rest)); kind == "spectral" || kind == "xyz")
      throw MalformedMtl("spectral curves and CIEXYZ are not supported");
    std::array<float, 3> kd{};
    const std::size_t count = take_numbers(line, kd);
    // A single number stands for all three channels.
    const bool is_grey = count == 1 && next_corner(line).empty();
    if (is_grey) kd[1] = kd[2] = kd[0];
    if ((count != 3 && !is_grey) || !all_finite(kd)) throw MalformedMtl(kColorNumbers);
    for (std::size_t c = 0; c < 3; ++c)
      color[static_cast<int>(c)] = srgb_to_linear(std::clamp(kd[c], 0.0f, 1.0f));
    if (std::any_of(kd.begin(), kd.end(), is_outside)) warn(kClamped);
  }

  void set_alpha(std::string_view line, bool is_transparency) {
    if (line.starts_with("-halo")) next_token(line);
    float value = 0;
    take_numbers(line, std::span(&value, 1), 1, "not a finite number");
    material_->alpha = std::clamp(is_transparency ? 1 - value : value, 0.0f, 1.0f);
    if (is_outside(value)) warn(kClamped);
  }

  void set_fraction(std::string_view line, float& fraction) {
    float value = 0;
    take_numbers(line, std::span(&value, 1), 1, "not a finite number");
    fraction = std::clamp(value, 0.0f, 1.0f);
    if (is_outside(value)) warn(kClamped);
  }

  void set_normal_map(std::string_view line, NormalMapKind kind) {
    material_->normal_map = {};
    attempt("the mesh's own normals replace the normal map", [&] {
      const MtlMap map = map_of(line);
      material_->normal_map = use(map);
      material_->normal_kind = kind;
      material_->normal_scale = map.bump;
    });
  }

  /// Parses a map statement; as plain text if only that names a file that exists.
  MtlMap map_of(std::string_view line) const {
    using enum NamedFiles::ByBaseName;
    MtlMap map = parse_mtl_map(line);
    try {
      const MtlMap plain = parse_mtl_map(line, MtlText::kPlain);
      if (plain.file != map.file && !files_.existing(folder_, map.file, kNever) &&
          files_.existing(folder_, plain.file, kAlways))
        return plain;
    } catch (const MalformedMtl&) {  // An option of the plain text is part of the name.
    }
    return map;
  }

  TextureUse use(const MtlMap& map) {
    TextureUse use;
    use.image = image(map.file);
    if (map.clamp) use.wrap_u = use.wrap_v = TextureWrap::kClamp;
    // The file's v runs up and ours, 1 - v, down: s * v + o becomes s * (1 - v) + (1 - s - o).
    use.uv = {map.scale[0], 0, 0, map.scale[1], map.offset[0], 1 - map.scale[1] - map.offset[1]};
    return use;
  }

  /// Returns the index of an image, which it adds if it is new.
  int image(const std::string& name) {
    std::vector<TextureImage>& images = appearance_.images;
    const std::filesystem::path path =
        files_.find(folder_, name, {file_, ErrorPlace::line(line_number_)});
    const std::string key = path.string();
    if (const auto known = images_.find(key)) return static_cast<int>(*known);
    if (images.size() == images.capacity())
      images.reserve(grown(images.size(), sizeof(TextureImage)));
    image_memory_.resize(image_memory_.bytes() + 3 * key.size());  // name, path and its parts
    images.push_back({printable_path(path.parent_path(), path.filename().string()), path, {}});
    return static_cast<int>(images_.find_or_add(key));
  }

  /// Reserves memory for twice as many elements and returns their number.
  std::size_t grown(std::size_t count, std::size_t element_bytes) {
    const std::size_t capacity = std::max<std::size_t>(16, 2 * count);
    image_memory_.resize(image_memory_.bytes() + capacity * element_bytes);
    return capacity;
  }

  static constexpr const char* kColorNumbers = "not one or three finite numbers";
  static constexpr const char* kClamped = "outside of 0 to 1: it is clamped";
  static bool is_outside(float value) { return value < 0 || value > 1; }

  const MeshSource& source_;
  const NamedFiles& files_;
  Appearance& appearance_;
  Warnings& warnings_;
  NameTable names_;                             ///< Names of the materials.
  NameTable plain_names_;                       ///< Those that differ, without quotes and comments.
  std::vector<std::uint32_t> with_plain_name_;  ///< The first material of each.
  NameTable images_;                            ///< Paths of the images.
  MemoryReservation image_memory_;
  std::vector<Described> described_;
  std::filesystem::path folder_;  ///< Folder of the current file.
  std::string file_;              ///< Its name in messages.
  std::size_t line_number_ = 1;
  std::string_view statement_;
  Material* material_ = nullptr;
  bool has_dissolve_ = false;  ///< The current material has a d.
  std::string hiding_;         ///< The place of the opacity that hides it; empty: none.
};

MtlReader::MtlReader(const MeshSource& source, const NamedFiles& files, Appearance& appearance,
                     Warnings& warnings)
    : impl_(std::make_unique<Impl>(source, files, appearance, warnings)) {}

MtlReader::~MtlReader() = default;

void MtlReader::read(std::string_view text, const std::filesystem::path& folder,
                     const std::string& name) {
  impl_->read(text, folder, name);
}

bool MtlReader::complete(std::size_t material) { return impl_->complete(material); }

}  // namespace voxdag
