#include "edit/edit_command.hpp"

#include <memory>
#include <utility>

#include "cli/output_files.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/long_vdag_file.hpp"
#include "voxdag/file/model/edited.hpp"
#include "voxdag/formats/exports/export_scene.hpp"

namespace voxdag::cli {

void add_edit(const Command& command, Session& session, const Edit& edit,
              const std::function<std::string()>& describe, const LongEdit& long_edit,
              bool makes_voxels) {
  const auto arguments = std::make_shared<EditArguments>();
  command.text("file", session.subject, "FILE", "The .vdag file, in either form").required();
  add_edit_options(command, *arguments, session, makes_voxels);
  command.when_parsed([=, &session] {
    check_distinct({{"--output", arguments->output}}, session);
    session.work = [=, &session] {
      check_dag_writable(arguments->output);
      MemoryBudget memory = command_budget(arguments->memory_limit);
      const Work work{&memory, &session.progress};
      VdagContainer opened(session.subject, &memory);
      if (long_edit && opened.kind() == VdagKind::kLong) {
        const LongVdagFile file(std::move(opened));
        Svdag dag =
            long_edit(file.view(), {session.subject, file.metadata().presentation.unit, work});
        write_edited(
            *arguments,
            edited(file.metadata(), std::move(dag), file.metadata().grid, describe(), &memory),
            arguments->compact, memory, session);
        return;
      }
      const DagModel file(std::move(opened), work);
      Placing placing{file.grid()};
      Svdag dag =
          edit(file.view(), placing,
               {session.subject, file.metadata().presentation.unit, work, up_of(file.metadata())});
      const PlacedModel source{file, placing.orientation, placing.offset};
      write_edited(*arguments, std::move(dag), placing.grid, {&source, 1}, describe(), memory,
                   session);
    };
  });
}

}  // namespace voxdag::cli
