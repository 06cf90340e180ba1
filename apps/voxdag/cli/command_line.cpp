#include "cli/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string_view>

#include "cli/spelling.hpp"

namespace voxdag::cli {
namespace {

constexpr std::size_t kNameColumns = 30, kLineColumns = 96;

/// Returns the text, broken into lines of at most kLineColumns columns that start in column
/// `indent`. The first line starts there without being indented.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string lines;
  std::size_t column = indent;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column != indent && column + 1 + word.size() > kLineColumns) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column != indent) {
      lines += " ";
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines;
}

/// Returns the name of an option and its description.
std::string help_row(const std::string& name, const std::string& description) {
  std::string text = "  " + name;
  if (text.size() + 2 > kNameColumns)
    text += "\n" + std::string(kNameColumns, ' ');
  else
    text.resize(kNameColumns, ' ');
  return text + wrapped(description, kNameColumns) + "\n";
}

/// Formats the help like CLI11, but with line breaks, and without lists of other options.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return help_row(make_option_name(option, is_positional) + make_option_opts(option),
                    option->get_description());
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0 || option->get_type_name().empty()) return "";
    const std::string name = option->get_type_name();
    return option->get_expected_min() == 0 ? fmt::format(" [{}]", name) : " " + name;
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return help_row(command->get_name(), command->get_description());
  }
  /// Breaks paragraphs into lines, and keeps lines that begin with two spaces, which are examples.
  std::string make_footer(const CLI::App* app) const override {
    std::string text;
    std::istringstream lines(app->get_footer());
    for (std::string line; std::getline(lines, line);)
      text += (line.starts_with("  ") ? line : wrapped(line, 0)) + "\n";
    return text;
  }
};

/// Throws UsageError for "--name=", which CLI11 would read as an option whose value follows.
void refuse_empty_values(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view text = argv[i];
    if (text == "--") return;
    if (text.starts_with("--") && text.find('=') == text.size() - 1)
      throw UsageError(std::string(text.substr(0, text.size() - 1)), "is empty");
  }
}

/// Returns the part of the command that was recognised: "voxdag bench trace".
std::string recognised_command(const CLI::App& app) {
  std::string words = app.get_name();
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands()[0];
    words += " " + command->get_name();
  }
  return words;
}

/// Returns the names of a command's options: "--output", "-o".
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// Returns "WORD", or "WORD (did you mean NAME?)".
std::string with_nearest(const std::string& word, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(word, names);
  return nearest.empty() ? word : fmt::format("{} (did you mean {}?)", word, nearest);
}

/// Returns the line about arguments that the command does not know, in their order; else what CLI11
/// says.
std::string reason_of(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::vector<std::string> unknown =
      chosen.empty() ? app.remaining() : chosen[0]->remaining();
  if (unknown.empty()) return error.what();
  if (chosen.empty() && !unknown[0].starts_with('-'))
    return "there is no command " + with_nearest(unknown[0], command_names(app));
  const std::vector<std::string> options = option_names(chosen.empty() ? app : *chosen[0]);
  std::vector<std::string> words;
  for (const std::string& word : unknown)
    words.push_back(word.starts_with('-') ? with_nearest(word.substr(0, word.find('=')), options)
                                          : word);
  return fmt::format("unknown argument{}: {}", words.size() == 1 ? "" : "s",
                     fmt::join(words, ", "));
}

/// Throws UsageError for "-res", which CLI11 would read as -r with the value "es", if at least
/// three letters begin a long option. "-r256" and "-qh" stay.
void refuse_single_dash(const std::string& word, const std::vector<std::string>& options) {
  if (word.size() < 4 || word[0] != '-' || word[1] == '-') return;
  for (const std::string& option : options)
    if (option.starts_with("-" + word))
      throw UsageError(fmt::format("unknown argument: {} (did you mean {}?)", word, option));
}

/// Turns "help build" into "build --help", and options in another spelling into those that the
/// command has: "--colour". "version" and "-v" become "--version".
std::vector<std::string> usual_arguments(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) return {"--help"};
  if (words.size() == 1 && (words[0] == "version" || words[0] == "-v" || words[0] == "-V"))
    return {"--version"};
  const std::vector<std::string> commands = command_names(app);
  const auto is_command = [&](const std::string& word) {
    return std::find(commands.begin(), commands.end(), word) != commands.end();
  };
  if (words[0] == "help") {
    words.erase(words.begin());
    if (words.empty() || is_command(words[0])) words.push_back("--help");
  }
  if (!is_command(words[0])) return words;
  const std::vector<std::string> options = option_names(*app.get_subcommand(words[0]));
  const auto is_known = [&](const std::string& name) {
    return std::find(options.begin(), options.end(), name) != options.end();
  };
  for (std::string& word : words) {
    if (word == "--") break;
    const std::string name = word.substr(0, word.find('='));
    refuse_single_dash(name, options);
    if (!word.starts_with("--") || is_known(name)) continue;
    for (const std::string& other : other_spellings(name))
      if (is_known(other)) word.replace(0, name.size(), other);
  }
  return words;
}

}  // namespace

CommandLine::CommandLine(const std::string& program, const std::string& purpose,
                         const std::string& version, const std::string& notes)
    : app_(std::make_unique<CLI::App>(purpose, program)) {
  app_->set_version_flag("--version", version, "Print the version and exit");
  app_->set_help_flag("-h,--help", "Print this help and exit");
  app_->require_subcommand(1);
  app_->footer(notes);
  app_->formatter(std::make_shared<HelpFormatter>());
}

CommandLine::~CommandLine() = default;

Command CommandLine::root() const { return Command(*app_); }

bool CommandLine::parse(int argc, char** argv) {
  try {
    refuse_empty_values(argc, argv);
    std::vector<std::string> words = usual_arguments(*app_, argc, argv);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app_->parse(words);
    return true;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      app_->exit(error);  // prints the help or the version
      return false;
    }
    throw UsageError(
        fmt::format("{} (usage: {} --help)", reason_of(*app_, error), recognised_command(*app_)));
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{} (usage: {} --help)", error.what(), recognised_command(*app_)));
  }
}

}  // namespace voxdag::cli
