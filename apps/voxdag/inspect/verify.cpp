/// `voxdag verify`: runs every check of a .vdag or .esvo file, and compares its voxels with the
/// mesh.
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "build/attribute_options.hpp"
#include "build/displace_option.hpp"
#include "cli/commands.hpp"
#include "cli/mesh_input.hpp"
#include "cli/stopwatch.hpp"
#include "inspect/verify_compact.hpp"
#include "voxdag/algebra/combine.hpp"
#include "voxdag/builders/attributes/check_attributes.hpp"
#include "voxdag/builders/attributes/cut_alpha.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/dag/check_cover.hpp"
#include "voxdag/builders/esvo/build/check_esvo.hpp"
#include "voxdag/builders/solid/solid_settings.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/file/verify_vdag.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag::cli {
namespace {

using Result = VerifyCheck::Result;

/// The maximum of --samples: hours of work on any machine.
constexpr std::int64_t kMaxSamples = 1'000'000'000;

struct VerifyArguments {
  std::string mesh;  ///< The first of `meshes`, for messages.
  std::vector<std::string> meshes;
  MeshAccess access;
  std::uint64_t samples = 20'000;
  std::uint64_t seed = 1;
  DisplaceArguments displace;
};

const char* result_name(Result result) {
  return result == Result::kPassed ? "passed" : result == Result::kFailed ? "FAILED" : "skipped";
}

/// If there are many samples, measures check() with fewer samples and announces the cost of
/// check(samples).
template <class Check>
void announce_samples(std::uint64_t samples, const Check& check, Session& session) {
  constexpr std::uint64_t kFew = 100'000, kProbe = 10'000;
  if (samples <= kFew) return;
  Stopwatch watch;
  check(1);  // the constant part of the cost
  const double constant = watch.lap();
  check(kProbe);
  const double probe = watch.lap() - constant;
  announce_cost(fmt::format("the check of {} samples", with_commas(samples)),
                probe / static_cast<double>(kProbe) * static_cast<double>(samples), session);
}

VerifyCheck cover_check(const VerifyArguments& arguments, const SvdagView& dag, const Grid& grid,
                        const Mesh& mesh, Session& session) {
  const auto check_samples = [&](std::uint64_t samples) {
    return check_cover(dag, grid, mesh, samples, arguments.seed, &session.progress);
  };
  announce_samples(arguments.samples, check_samples, session);
  const CoverCheck cover = check_samples(arguments.samples);
  VerifyCheck check{"cover", Result::kPassed, {}};
  if (cover.mismatches > 0) {
    check.result = Result::kFailed;
    check.detail =
        fmt::format("{} of {} cells differ from {}; the first one is cell ({}, {}, {}) of level {}",
                    with_commas(cover.mismatches), with_commas(cover.samples), arguments.mesh,
                    cover.first_mismatch.x, cover.first_mismatch.y, cover.first_mismatch.z,
                    cover.first_mismatch_level);
  } else {
    check.detail = fmt::format("{} cells, {} of them on the surface", with_commas(cover.samples),
                               with_commas(cover.covered));
  }
  return check;
}

/// Compares one kind of attribute: its largest error with the encoder's bound and a tolerance for
/// rounding. `unit` follows the errors.
VerifyCheck value_check(const char* name, const ValueCheck& values, double bound, double tolerance,
                        const char* unit, const std::string& mesh) {
  VerifyCheck check{name, Result::kPassed, {}};
  const double allowed = bound + tolerance;
  if (values.largest_error <= allowed) {
    check.detail =
        fmt::format("{} cells, largest error {:.4g}{} of {:.4g}{}", with_commas(values.cells),
                    values.largest_error, unit, allowed, unit);
    return check;
  }
  check.result = Result::kFailed;
  check.detail = fmt::format(
      "cell ({}, {}, {}) of level {} differs from {} by {:.4g}{}; the bound and rounding allow "
      "{:.4g}{}",
      values.worst.x, values.worst.y, values.worst.z, values.worst_level, mesh,
      values.largest_error, unit, allowed, unit);
  return check;
}

/// Compares the attributes with the mesh. `cover` is the DAG of the mesh if the file has a solid,
/// else null. Returns no checks if the file has no attributes.
std::vector<VerifyCheck> attribute_checks(const VerifyArguments& arguments, const DagModel& file,
                                          const JoinedMeshes& meshes, const SvdagView* cover,
                                          Session& session) {
  const DagAttributesView attributes = file.attributes();
  if (attributes.is_empty()) return {};
  const MeshWithAppearance& source = meshes.source;
  NamedIds ids;
  if (attributes.has_materials()) {
    if (const auto kind = file.metadata().build.find("ids"); kind != file.metadata().build.end())
      ids = named_ids(kind->second == "file" ? IdKind::kFile : IdKind::kObject, meshes,
                      arguments.meshes, nullptr);
    else if (source.mesh.triangle_materials.empty())
      return {{"material ids", Result::kFailed, arguments.mesh + " has no materials"}};
  }
  const bool has_mirrors = !metallic_roughness_of(attributes.channels).is_empty();
  const SurfaceShading shading(source.mesh, source.appearance, nullptr, &session.progress,
                               has_mirrors);
  const AttributeCheck found =
      check_attributes(source.mesh, file.grid(), {file.view(), attributes}, shading,
                       arguments.samples, arguments.seed, &session.progress, ids.view(), cover);
  const AttributesMetadata& stored = file.metadata().attributes;
  std::vector<VerifyCheck> checks;
  if (attributes.has_colors())
    checks.push_back(value_check("colours", found.colors, stored.colors->bound, kColorTolerance, "",
                                 arguments.mesh));
  if (attributes.has_normals())
    checks.push_back(value_check("normals", found.normals, stored.normals->bound, kNormalTolerance,
                                 "°", arguments.mesh));
  if (attributes.has_materials())
    checks.push_back(value_check("material ids", found.materials, 0, kMaterialTolerance,
                                 " of the area", arguments.mesh));
  if (has_mirrors)
    checks.push_back(
        value_check("channels", found.metallic_roughness, 0, kMirrorTolerance, "", arguments.mesh));
  return checks;
}

/// Reads the meshes and moves them as the build of the file did. Without `with_appearance`, their
/// appearance is a default one.
JoinedMeshes read_meshes_of(const VerifyArguments& arguments, const SceneMetadata& metadata,
                            bool with_appearance, Session& session) {
  MeshAccess access = arguments.access;
  access.objects = metadata.build.contains("ids");
  try {
    access.transform = transform_request(metadata.build);
    InputTransform(access.transform, {});
  } catch (const std::invalid_argument& wrong) {
    throw Error(session.subject, "build", wrong.what());
  }
  JoinedMeshes meshes = read_mesh_files(arguments.meshes, with_appearance, access, session);
  if (!with_appearance)
    meshes.source.appearance.materials.resize(
        std::max<std::size_t>(meshes.source.mesh.materials.size(), 1));
  return meshes;
}

/// Compares a solid DAG with the mesh: its surface, its inside, and the attributes of the surface.
std::vector<VerifyCheck> solid_checks(const VerifyArguments& arguments, const DagModel& file,
                                      const JoinedMeshes& meshes, Session& session) {
  const Mesh& mesh = meshes.source.mesh;
  const std::map<std::string, std::string>& settings = file.metadata().build;
  const std::string& rule = settings.at("solid");
  const Work work = &session.progress;
  const Svdag surface = build_svdag(mesh, file.grid(), {}, work).dag;
  std::vector<VerifyCheck> checks = {
      cover_check(arguments, surface.view(), file.grid(), mesh, session)};
  if (checks[0].result != Result::kPassed) return checks;
  VerifyCheck check{"solid", Result::kPassed, {}};
  try {
    const Svdag filled =
        fill_solid(surface.view(), mesh, file.grid(), solid_options(settings), work);
    const Svdag different = combine(file.view(), filled.view(), SetOperation::kSymmetric, work);
    const std::uint64_t voxels = count_svdag(different.view()).voxels;
    check.detail = fmt::format("{} voxels differ from the inside of {} by {}", with_commas(voxels),
                               arguments.mesh, rule);
    if (voxels > 0) check.result = Result::kFailed;
  } catch (const std::invalid_argument&) {
    check.result = Result::kFailed;
    check.detail = "the file has an unknown rule for the inside: " + printable(rule);
  }
  checks.push_back(std::move(check));
  if (checks.back().result != Result::kPassed) return checks;
  const SvdagView cover = surface.view();
  for (VerifyCheck& values : attribute_checks(arguments, file, meshes, &cover, session))
    checks.push_back(std::move(values));
  return checks;
}

/// Compares a DAG without the voxels that the alpha test removes with the mesh: its surface, and
/// then what is left of it.
std::vector<VerifyCheck> alpha_checks(const VerifyArguments& arguments, const DagModel& file,
                                      const MeshWithAppearance& source, Session& session) {
  const Work work = &session.progress;
  const Svdag surface = build_svdag(source.mesh, file.grid(), {}, work).dag;
  std::vector<VerifyCheck> checks = {
      cover_check(arguments, surface.view(), file.grid(), source.mesh, session)};
  if (checks[0].result != Result::kPassed) return checks;
  const SurfaceShading shading(source.mesh, source.appearance, nullptr, work);
  const auto cut = cut_alpha(source.mesh, file.grid(), surface.view(), shading, work);
  const Svdag different =
      combine(file.view(), (cut ? *cut : surface).view(), SetOperation::kSymmetric, work);
  const std::uint64_t voxels = count_svdag(different.view()).voxels;
  checks.push_back({"alpha", voxels > 0 ? Result::kFailed : Result::kPassed,
                    fmt::format("{} voxels differ from the visible surface of {}",
                                with_commas(voxels), arguments.mesh)});
  return checks;
}

/// Compares the voxels and the attributes of a DAG with the mesh.
std::vector<VerifyCheck> dag_checks(const VerifyArguments& arguments, const VdagContainer& opened,
                                    Session& session) {
  if (!arguments.displace.texture.empty())
    throw Error(session.subject, "", "--displace is for ESVOs only, but this file is a DAG");
  const DagModel file(opened, &session.progress);
  const bool is_cut = file.metadata().build.contains("alpha");
  const JoinedMeshes meshes =
      read_meshes_of(arguments, file.metadata(),
                     is_cut || file.attributes().has_colors() || file.attributes().has_normals() ||
                         !metallic_roughness_of(file.attributes().channels).is_empty(),
                     session);
  const MeshWithAppearance& source = meshes.source;
  if (file.metadata().build.contains("solid"))
    return solid_checks(arguments, file, meshes, session);
  std::vector<VerifyCheck> checks =
      is_cut ? alpha_checks(arguments, file, source, session)
             : std::vector{cover_check(arguments, file.view(), file.grid(), source.mesh, session)};
  // If the voxels differ from the mesh, the attributes do too.
  if (checks.back().result != Result::kPassed) return checks;
  for (VerifyCheck& check : attribute_checks(arguments, file, meshes, nullptr, session))
    checks.push_back(std::move(check));
  return checks;
}

void print_checks(const std::vector<VerifyCheck>& checks, bool json) {
  if (!json) {
    for (const VerifyCheck& check : checks)
      fmt::print("  {:<16}{}{}{}\n", check.name, result_name(check.result),
                 check.detail.empty() ? "" : "   ", check.detail);
    return;
  }
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  bool passed = true;
  for (const VerifyCheck& check : checks) {
    passed = passed && check.result != Result::kFailed;
    list.push_back(
        {{"name", check.name},
         {"result", check.result == Result::kFailed ? "failed" : result_name(check.result)},
         {"detail", check.detail}});
  }
  fmt::print("{}", json_text(nlohmann::ordered_json{{"passed", passed}, {"checks", list}}));
}

/// Returns the displacement of the surface, from the options or from the file's metadata. Returns
/// nothing if the file names a texture, because its folder is unknown.
std::optional<DisplaceArguments> displacement_of(const EsvoFile& file,
                                                 const DisplaceArguments& asked) {
  if (!asked.texture.empty()) return asked;
  const std::map<std::string, std::string>& build = file.metadata().build;
  DisplaceArguments arguments;
  arguments.is_off = !build.contains("displaced");
  if (!build.contains("displace")) return arguments;
  parse_displace(build.at("displace"), arguments);
  if (arguments.texture != "stone") return std::nullopt;
  return arguments;
}

/// Checks that the octree contains random points of the mesh.
VerifyCheck enclosure_check(const VerifyArguments& arguments, const VdagContainer& opened,
                            Session& session) {
  const EsvoFile file(opened);
  const std::optional<DisplaceArguments> displace = displacement_of(file, arguments.displace);
  if (!displace)
    return {"enclosure", Result::kSkipped,
            fmt::format("the surface is displaced: give the --displace of the build, which was {}",
                        file.metadata().build.at("displace"))};
  const MeshWithAppearance source =
      read_meshes_of(arguments, file.metadata(), true, session).source;
  const SurfaceShading shading(source.mesh, source.appearance, nullptr, &session.progress);
  std::vector<std::string> warnings;
  const std::optional<DisplacedTriangles> displaced =
      open_displaced(*displace, source.mesh, source.appearance, warnings, &session.progress);
  const QuantizedMesh quantized(source.mesh, file.grid());
  const auto check_samples = [&](std::uint64_t samples) {
    return check_enclosure(file.view(), quantized, file.grid(), &shading,
                           displaced ? &*displaced : nullptr, samples, arguments.seed,
                           &session.progress);
  };
  announce_samples(arguments.samples, check_samples, session);
  const EnclosureCheck enclosure = check_samples(arguments.samples);
  VerifyCheck check{"enclosure", Result::kPassed,
                    fmt::format("{} points of the surface", with_commas(enclosure.points))};
  if (enclosure.points == 0 && arguments.samples > 0 && !file.view().is_empty()) {
    check.result = Result::kFailed;
    check.detail = fmt::format("no point of {} is in the grid", arguments.mesh);
  }
  if (!enclosure.outside) return check;
  const Vec3d at = file.grid().to_world(enclosure.outside->point);
  check.result = Result::kFailed;
  check.detail = fmt::format(
      "point ({2:.9g}, {3:.9g}, {4:.9g}) of triangle {0} of {1} is outside the octree at level {5}",
      enclosure.outside->triangle, arguments.mesh, at.x, at.y, at.z, enclosure.outside->level);
  return check;
}

std::vector<VerifyCheck> mesh_checks(const VerifyArguments& arguments, const VdagContainer& opened,
                                     Session& session) {
  if (opened.kind() == VdagKind::kEsvo) return {enclosure_check(arguments, opened, session)};
  return dag_checks(arguments, opened, session);
}

void verify(const VerifyArguments& arguments, Session& session) {
  const VdagContainer opened(session.subject);
  VerifyReport report = opened.is(VdagKind::kCompact) ? verify_compact(opened, &session.progress)
                                                      : verify_vdag(opened);
  session.progress.throw_if_cancelled();
  if (!arguments.mesh.empty()) {
    if (report.passed())
      for (VerifyCheck& check : mesh_checks(arguments, opened, session))
        report.checks.push_back(std::move(check));
    else
      report.checks.push_back(
          {"mesh", Result::kSkipped, "not checked, because the file is damaged"});
  }
  session.bar.clear();
  if (session.json || !session.quiet) print_checks(report.checks, session.json);
  for (const VerifyCheck& check : report.checks)
    if (check.result == Result::kFailed) throw Error(session.subject, check.name, check.detail);
}

}  // namespace

void add_verify_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<VerifyArguments>();
  const Command command = program.add(
      "verify",
      "Check a .vdag or .esvo file: checksums, structure, minimality; with --mesh also its voxels "
      "and attributes",
      "voxdag verify sponza.vdag --mesh sponza.obj --samples 100000\n\n"
      "Checks the container, the checksums, the metadata and the structure; for a DAG also the "
      "canonical order, the minimality, the counts and the attributes. A DAG in the compact form "
      "is "
      "decoded and encoded again, which must give the same bytes. The exit status is 1 if a check "
      "fails.\n\n"
      "With --mesh, the command checks a random sample of a DAG's cells, and of its colours, "
      "normals "
      "and materials. For an ESVO it checks that random points of the surface, among them corners "
      "and points on edges, lie in a leaf and between the planes of every contour above the leaf. "
      "If "
      "a texture file displaced the surface, give the --displace of the build.");
  command.text("file", session.subject, "FILE", "The .vdag or .esvo file").required();
  const Option mesh = command.repeated(
      "--mesh", arguments->meshes, [](const std::string& text) { return text; }, "MESH",
      "Compare voxels and attributes with this mesh, in random cells or points. "
      "Give all meshes of the build, in its order");
  command
      .number("--samples", arguments->samples, NumberRange::whole(0, kMaxSamples), "N",
              "With --mesh: number of random cells or points")
      .needs(mesh);
  command
      .number("--seed", arguments->seed,
              NumberRange::whole(0, std::numeric_limits<std::int64_t>::max()), "N",
              "With --mesh: seed of the random numbers")
      .needs(mesh)
      .only_if([arguments] { return arguments->samples > 0; }, "with --samples 0");
  add_displace_option(command, arguments->displace).needs(mesh);
  add_mesh_access_options(command, arguments->access, &mesh);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.when_parsed([arguments, &session] {
    if (!arguments->meshes.empty()) arguments->mesh = arguments->meshes.front();
    session.work = [arguments, &session] { verify(*arguments, session); };
  });
}

}  // namespace voxdag::cli
