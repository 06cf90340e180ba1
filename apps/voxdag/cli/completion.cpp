/// `voxdag completion`: prints a script for completion in a shell, generated from the parser.
#include <fmt/core.h>

#include <memory>

#include "cli/commands.hpp"

namespace voxdag::cli {
namespace {

/// Returns a bash script that completes subcommands, their options and file names.
std::string bash_completion(const Command& program) {
  std::string commands, cases;
  for (const Command& command : program.subcommands()) {
    commands += command.name() + " ";
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command.name(), command.option_names());
  }
  return fmt::format(R"(# bash completion of {0}: source this file, or put it into
# ~/.local/share/bash-completion/completions/{0}
_{0}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} words
  case ${{COMP_WORDS[1]}} in
{1}    *) words="{2}" ;;
  esac
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "{3}{2}" -- "$current")
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -o filenames -F _{0} {0}
)",
                     program.name(), cases, program.option_names(), commands);
}

void check_shell(const std::string& shell) {
  if (shell != "bash")
    throw UsageError("shell", fmt::format("\"{}\" is unknown: only bash is supported", shell));
}

}  // namespace

void add_completion_command(const Command& program, Session& session) {
  const auto shell = std::make_shared<std::string>();
  const Command command =
      program.add("completion", "Print a script that completes command lines in a shell",
                  "voxdag completion bash > ~/.local/share/bash-completion/completions/voxdag");
  command.text("shell", *shell, "SHELL", "The shell: bash").required();
  command.when_parsed([program, shell, &session] {
    check_shell(*shell);
    session.work = [program] { fmt::print("{}", bash_completion(program)); };
  });
}

}  // namespace voxdag::cli
