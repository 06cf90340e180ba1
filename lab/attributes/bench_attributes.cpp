#include "lab/attributes/bench_attributes.hpp"

#include <fmt/core.h>

#include <limits>
#include <memory>
#include <numeric>

#include "lab/attributes/cell_colors.hpp"
#include "lab/attributes/color_pictures.hpp"
#include "lab/attributes/dolonius.hpp"
#include "lab/attributes/esvo_blocks.hpp"
#include "lab/build/bench_mesh.hpp"
#include "lab/report/scratch_folder.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/dag/stop_watch.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/wire/wire_values.hpp"

namespace voxdag::lab {
namespace {

using Colors = std::vector<Value8>;

/// Encodes colours as the builder of .vdag files does, on all threads.
ValuePages encode_pages(const Colors& colors, double bound, ValueErrors& errors,
                        const Progress& progress) {
  constexpr std::size_t kPart = 256 * kPageValues;
  ValueEncoder encoder(colors.size(), make_value_metric(kColorWeights, 255 * bound), nullptr);
  parallel_for((colors.size() + kPart - 1) / kPart, [&](std::size_t i) {
    progress.throw_if_cancelled();
    const std::size_t begin = i * kPart;
    encoder.add(begin, std::span(colors).subspan(begin, std::min(kPart, colors.size() - begin)));
  });
  ValuePages pages = encoder.finish();
  errors = encoder.errors();
  return pages;
}

double psnr_of(const ValueErrors& errors, std::size_t cells) {
  AttributesMetadata metadata;
  metadata.colors = {0, errors.squared};
  return metadata.color_psnr_db(cells);
}

double psnr_of(const Colors& given, const Colors& stored) {
  ValueErrors errors;
  for (std::size_t i = 0; i < given.size(); ++i) errors.count(given[i], stored[i]);
  return psnr_of(errors, given.size());
}

/// The colours of one DAG, and their pictures.
class ColoredScene {
 public:
  ColoredScene(const SvdagView& dag, const Grid& grid, const CellIndexView& index, Colors colors,
               int views, Progress& progress)
      : dag_(dag), index_(index), colors_(std::move(colors)), progress_(progress) {
    pictures_ =
        std::make_unique<ColorPictures>(dag_, grid, views, exact(colors_).attributes, progress_);
  }

  ColorResult voxdag(double bound) const {
    ColorResult result;
    result.bound = bound;
    StopWatch watch;
    ValueErrors errors;
    const ValuePages pages = encode_pages(colors_, bound, errors, progress_);
    result.seconds = watch.lap();
    result.bytes = pages.view().bytes();
    const wire::WireValues coded = wire::encode_wire_values(pages.view(), wire::ValueKind::kColor);
    result.wire_bytes = coded.bytes.size() + coded.segments.size() * sizeof(wire::WireSegment);
    result.psnr_db = psnr_of(errors, colors_.size());
    result.ms_ssim = pictures_->similarities({index_, pages.view(), {}, {}}, progress_);
    return result;
  }

  ColorResult dolonius(double threshold) const {
    std::vector<ColorBytes> bytes;
    bytes.reserve(colors_.size());
    for (const Value8 color : colors_)
      bytes.push_back(color.x | static_cast<ColorBytes>(color.y) << 8 |
                      static_cast<ColorBytes>(color.z) << 16);
    ColorResult result;
    result.codec = ColorCodec::kDolonius;
    result.bound = threshold;
    StopWatch watch;
    const EncodedColors encoded = encode_dolonius(bytes, static_cast<float>(threshold), progress_);
    result.seconds = watch.lap();
    result.bytes = encoded.size.bytes();
    Colors stored;
    stored.reserve(colors_.size());
    for (const ColorBytes color : encoded.colors)
      stored.push_back({static_cast<std::uint8_t>(color), static_cast<std::uint8_t>(color >> 8),
                        static_cast<std::uint8_t>(color >> 16)});
    compare(stored, result);
    return result;
  }

  ColorResult esvo() const {
    ColorResult result;
    result.codec = ColorCodec::kEsvo;
    result.bound = std::numeric_limits<double>::quiet_NaN();
    StopWatch watch;
    const EsvoColors encoded = encode_esvo_colors(dag_, index_, colors_, progress_);
    result.seconds = watch.lap();
    result.bytes = 8 * encoded.blocks;
    compare(encoded.colors, result);
    return result;
  }

 private:
  /// Colours in exact pages, for pictures.
  struct Exact {
    ValuePages pages;
    DagAttributesView attributes;
  };
  Exact exact(const Colors& colors) const {
    ValueErrors errors;
    Exact result{encode_pages(colors, 0, errors, progress_), {}};
    result.attributes = {index_, result.pages.view(), {}, {}};
    return result;
  }

  void compare(const Colors& stored, ColorResult& result) const {
    result.psnr_db = psnr_of(colors_, stored);
    result.ms_ssim = pictures_->similarities(exact(stored).attributes, progress_);
  }

  const SvdagView& dag_;
  const CellIndexView index_;
  const Colors colors_;
  Progress& progress_;
  std::unique_ptr<ColorPictures> pictures_;
};

class Bench {
 public:
  Bench(const AttributesPlan& plan, Progress& progress) : plan_(plan), progress_(progress) {}

  AttributesResults run() {
    measure_scenes(plan_.scenes, results_.runs,
                   [this](const std::string& scene) { measure(scene); });
    return std::move(results_);
  }

 private:
  void measure(const std::string& scene) {
    const PreparedMesh prepared = prepare_mesh(scene, folder_.path(), progress_);
    MemoryBudget memory = command_budget(0);
    ReadOptions read = plan_.read;
    read.work = {&memory, &progress_};
    const MeshWithAppearance source = read_mesh_with_appearance(prepared.path, read);
    const SurfaceShading shading(source.mesh, source.appearance, nullptr, {&memory, &progress_});
    for (const int levels : plan_.levels) {
      AttributesRun& run = results_.runs.emplace_back();
      run.scene = prepared.identity.name;
      run.levels = levels;
      measure(source.mesh, shading, memory, run);
    }
  }

  void measure(const Mesh& mesh, const SurfaceShading& shading, MemoryBudget& memory,
               AttributesRun& run) {
    const Grid grid = fit_grid(mesh, run.levels);
    const BuildResult built = build_svdag(mesh, grid, {}, {&memory, &progress_});
    const SvdagView dag = built.dag.view();
    run.voxels = count_svdag(dag).voxels;
    if (run.voxels == 0) throw Error(run.scene, std::to_string(1 << run.levels), "has no voxels");
    const CellIndex index = build_cell_index(dag, run.levels, &memory);
    run.cells = index.cells;
    run.index_bytes = index.view().bytes();
    CellColors cells(index.cells);
    StopWatch watch;
    filter_cells(mesh, grid, dag, index.view(), &shading, cells, {&memory, &progress_});
    run.filter_seconds = watch.lap();
    const ColoredScene colored(dag, grid, index.view(), std::move(cells.colors), plan_.views,
                               progress_);
    for (const ColorCodec codec : plan_.codecs) {
      progress_.report(
          fmt::format("encoding {} {} as {}", run.scene, 1 << run.levels, key_of(codec)), 0);
      if (codec == ColorCodec::kVoxdag)
        for (const double bound : plan_.bounds) run.results.push_back(colored.voxdag(bound));
      else if (codec == ColorCodec::kDolonius)
        for (const double threshold : plan_.thresholds)
          run.results.push_back(colored.dolonius(threshold));
      else
        run.results.push_back(colored.esvo());
    }
  }

  const AttributesPlan& plan_;
  Progress& progress_;
  ScratchFolder folder_;
  AttributesResults results_;
};

}  // namespace

std::string key_of(ColorCodec codec) {
  return codec == ColorCodec::kVoxdag     ? "voxdag"
         : codec == ColorCodec::kDolonius ? "dolonius"
                                          : "esvo";
}

double ColorResult::mean_ms_ssim() const {
  return std::accumulate(ms_ssim.begin(), ms_ssim.end(), 0.0) / static_cast<double>(ms_ssim.size());
}

double AttributesRun::bits_per_cell(const ColorResult& result) const {
  return 8 * static_cast<double>(result.bytes) / static_cast<double>(cells);
}

AttributesResults bench_attributes(const AttributesPlan& plan, Progress& progress) {
  return Bench(plan, progress).run();
}

}  // namespace voxdag::lab
