#pragma once
/// What the subcommands share: the options that many of them have, progress and cancellation.
#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/progress_bar.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// A subcommand declares its options on the parser and sets `work`, which runs once the whole
/// command line is known to be right.
struct Session {
  std::function<void()> work;
  /// Files that are read: none is to be written.
  std::vector<std::string> inputs;
  std::string subject;  ///< The file that the work is about, for errors that do not name one.
  int threads = 0;      ///< 0: one for each processor.
  bool quiet = false;   ///< Neither progress bar nor summary.
  bool json = false;    ///< The result as JSON on stdout.

  ProgressBar bar;
  Progress progress{[this](std::string_view stage, double fraction, std::uint64_t items) {
    bar.update(stage, fraction, items);
  }};
};

/// Adds a subcommand with its one-line purpose and an example for the end of its help.
CLI::App& add_command(CLI::App& app, const std::string& name, const std::string& purpose,
                      const std::string& example);

void add_threads_option(CLI::App& command, Session& session);
void add_quiet_option(CLI::App& command, Session& session);
void add_json_option(CLI::App& command, Session& session);

/// An option whose text `parse` turns into a value; parse throws std::invalid_argument with the
/// reason where the text is wrong, which makes a usage error. `shape` is shown in the help:
/// "X,Y,Z".
template <class Target, class Value>
CLI::Option* add_parsed_option(CLI::App& command, const std::string& name, Target& target,
                               Value (*parse)(const std::string&), const std::string& shape,
                               const std::string& help) {
  const auto store = [&target, parse, name](const std::string& text) {
    try {
      target = parse(text);
    } catch (const std::invalid_argument& wrong) {
      throw CLI::ValidationError(name, wrong.what());
    }
  };
  return command.add_option_function<std::string>(name, store, help)->type_name(shape);
}

/// Appends each of the texts of an option that takes several, as `parse` has it; likewise.
template <class Value, class Parse>
void parse_all(const std::string& option, const std::vector<std::string>& texts, const Parse& parse,
               std::vector<Value>& values) {
  for (const std::string& text : texts) {
    try {
      values.push_back(parse(text));
    } catch (const std::invalid_argument& wrong) {
      throw CLI::ValidationError(option, "\"" + text + "\": " + wrong.what());
    }
  }
}

/// "voxdag: TEXT" as one line on stderr, whatever stands in the text: file names may hold line
/// breaks. Where stderr is closed nobody hears of it.
void print_line(std::string text);

/// On stderr, a line each.
void print_warnings(const std::vector<std::string>& warnings, Session& session);

/// A warning if what was built into `output` has nothing in it.
void warn_if_empty(std::uint64_t voxels, const std::string& output, Session& session);

/// Indented, with a line break behind it. Names of files may have bytes that are no UTF-8: U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

/// Throws Error unless a file can be made at `path`: called before long work, not after it.
void check_writable(const std::string& path);

}  // namespace voxdag
