/// Completion of the command line in a shell, made from the parser itself.
#include <fmt/core.h>

#include "cli/commands.hpp"

namespace voxdag {
namespace {

std::string option_names(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
    for (const std::string& name : option->get_snames()) words += "-" + name + " ";
  }
  if (!words.empty()) words.pop_back();
  return words;
}

/// A bash script that completes subcommands, their options and file names.
std::string bash_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands += command->get_name() + " ";
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), option_names(*command));
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
                     app.get_name(), cases, option_names(app), commands);
}

}  // namespace

void add_completion_command(CLI::App& app, Session& session) {
  CLI::App& command =
      add_command(app, "completion", "Print a script that completes command lines in a shell",
                  "voxdag completion bash > ~/.local/share/bash-completion/completions/voxdag");
  command.add_option("shell", "The shell: bash")->required()->check(CLI::IsMember({"bash"}));
  command.callback(
      [&app, &session] { session.work = [&app] { fmt::print("{}", bash_completion(app)); }; });
}

}  // namespace voxdag
