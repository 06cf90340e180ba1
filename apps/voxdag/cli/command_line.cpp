#include "cli/command_line.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <string_view>

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

std::string reason_of(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining();
  if (app.get_subcommands().empty() && !unknown.empty())
    return fmt::format("there is no command \"{}\"", unknown[0]);
  return error.what();
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
    app_->parse(argc, argv);
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
