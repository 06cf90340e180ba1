/// `voxdag info`: describes the contents of a .vdag or .esvo file.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/long_vdag_file.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/file/report/dag_report.hpp"
#include "voxdag/file/report/esvo_report.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/file/wire_chunks.hpp"

namespace voxdag::cli {
namespace {

void esvo_info(const VdagContainer& opened, bool json) {
  const EsvoFile file(opened);
  const EsvoReport report = report_of(file.contents(), file.file_bytes());
  if (json)
    fmt::print("{}", json_text(esvo_json(report)));
  else
    fmt::print("{}: {}, written by {}\n{}\n{}", opened.path().string(),
               human_bytes(report.file_bytes), printable(report.metadata.program),
               esvo_table(report), esvo_level_table(report));
}

/// Decodes a compact DAG, so that the report has the bytes of both forms.
DagReport dag_report(const VdagContainer& opened, Work work) {
  if (opened.kind() == VdagKind::kLong) {
    const LongVdagFile file(opened);
    return report_of(file.view(), file.metadata(), file.file_bytes());
  }
  const DagModel file(opened, work);
  DagReport report = report_of(file.view(), file.metadata(), file.file_bytes());
  report.attributes = sizes_of(file.attributes());
  const WireBytes wire = wire_bytes_of(opened);
  report.attributes.is_wire = wire.expanded > 0;
  if (wire.colors > 0) report.attributes.color_bytes = wire.colors;
  if (wire.normals > 0) report.attributes.normal_bytes = wire.normals;
  if (wire.materials > 0) report.attributes.material_bytes = wire.materials;
  if (!file.is_compact()) return report;
  const CompactFile compact(opened);
  report.compact = bytes_of(compact.view(), compact.head_bytes());
  return report;
}

void info(const std::string& path, bool json, Work work) {
  const VdagContainer opened(path);
  if (opened.kind() == VdagKind::kEsvo) return esvo_info(opened, json);
  const DagReport report = dag_report(opened, work);
  if (json) {
    fmt::print("{}", json_text(dag_json(report)));
    return;
  }
  fmt::print("{}: {}, written by {}\n{}\n{}", path, human_bytes(report.file_bytes),
             printable(report.metadata.program), dag_table(report),
             level_table(report.metadata.counts));
}

}  // namespace

void add_info_command(const Command& program, Session& session) {
  const Command command =
      program.add("info", "Print the counts, sizes, placement and source of a .vdag or .esvo file",
                  "voxdag info scene.vdag --json");
  command.text("file", session.subject, "FILE", "The .vdag or .esvo file").required();
  add_json_option(command, session);
  command.when_parsed([&session] {
    session.work = [&session] { info(session.subject, session.json, &session.progress); };
  });
}

}  // namespace voxdag::cli
