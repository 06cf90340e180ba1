#include "cli/command.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "cli/output_files.hpp"
#include "cli/spelling.hpp"

namespace voxdag::cli {
namespace {

/// Calls store() with the text in other spellings: "centre" and "center". Leaves what follows "=",
/// which may be a file. Returns whether one of them was stored.
bool stores_other_spelling(const std::function<void(const std::string&)>& store,
                           const std::string& text) {
  const std::string name = text.substr(0, text.find('='));
  for (const std::string& other : other_spellings(name)) {
    try {
      if (other == name) continue;
      store(other + text.substr(name.size()));
      return true;
    } catch (const std::invalid_argument&) {  // not this one either
    }
  }
  return false;
}

/// Calls store(text). Turns exceptions of parse functions into a UsageError that names the option.
void store_or_refuse(const CLI::Option& option,
                     const std::function<void(const std::string&)>& store,
                     const std::string& text) {
  if (text.empty()) throw UsageError(option.get_name(), "is empty");
  try {
    store(text);
  } catch (const std::invalid_argument& wrong) {
    if (!stores_other_spelling(store, text)) throw UsageError(option.get_name(), wrong.what());
  }
}

}  // namespace

bool Option::is_given() const { return option_->count() > 0; }
std::string Option::name() const { return option_->get_name(); }

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::in_group(const std::string& group) const {
  option_->group(group);
  return *this;
}

Option Option::only_if(std::function<bool()> has_effect, const std::string& why_not) const {
  rules_.lock()->push_back({option_, std::move(has_effect), why_not});
  return *this;
}

Option Option::needs(const Option& other) const {
  return only_if([other] { return other.is_given(); }, "without " + other.name());
}

Option Option::not_with(const Option& other) const {
  return only_if([other] { return !other.is_given(); }, "with " + other.name());
}

Command::Command(CLI::App& app) : app_(&app), rules_(std::make_shared<EffectRules>()) {}

Command Command::with_heading(const std::string& heading) const {
  Command command = *this;
  command.heading_ = heading;
  return command;
}

Command Command::add(const std::string& name, const std::string& purpose,
                     const std::string& footer) const {
  CLI::App& command = *app_->add_subcommand(name, purpose);
  command.footer("Example:\n  " + footer);
  if (!heading_.empty()) command.group(heading_);
  return Command(command);
}

void Command::pass_on(std::function<void(std::vector<std::string>)> run) const {
  app_->prefix_command();
  app_->set_help_flag();
  app_->parse_complete_callback([app = app_, run = std::move(run)] { run(app->remaining()); });
}

Option Command::text(const std::string& names, std::string& value, const std::string& shape,
                     const std::string& help) const {
  const bool is_output = names == "-o,--output";
  return add_option(
      names,
      [&value, is_output](const std::string& text) {
        value = is_output && text == "-" ? standard_output() : text;
      },
      shape, help);
}

Option Command::texts(const std::string& name, std::vector<std::string>& values,
                      const std::string& shape, const std::string& help) const {
  const auto store = [&values, name](const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      if (text.empty()) throw UsageError(name, "is empty");
    values = texts;
  };
  CLI::Option* const option =
      app_->add_option_function<std::vector<std::string>>(name, store, help)->type_name(shape);
  return {option, rules_};
}

Option Command::flag(const std::string& names, bool& value, const std::string& help) const {
  return {app_->add_flag(names, value, help), rules_};
}

Option Command::off_switch(const std::string& name, bool& value, const std::string& help) const {
  return {app_->add_flag_callback(
              name, [&value] { value = false; }, help),
          rules_};
}

Option Command::flag_or_number(const std::string& name, int& value, const NumberRange& range,
                               int if_left_out, const std::string& shape,
                               const std::string& help) const {
  const auto store = [&value, range](const std::string& text) { value = range.parse<int>(text); };
  const std::string default_value = std::to_string(if_left_out);
  const Option option = add_option(name, store, shape, help + note(range, default_value));
  make_optional(name, default_value);
  return option;
}

void Command::make_optional(const std::string& name, const std::string& if_left_out) const {
  app_->get_option(name)->expected(0, 1)->default_str(if_left_out);
}

Option Command::add_option(const std::string& names, const Store& store, const std::string& shape,
                           const std::string& help) const {
  // The callback needs the option, which add_option_function returns.
  const auto option = std::make_shared<CLI::Option*>();
  *option = app_->add_option_function<std::string>(
      names, [option, store](const std::string& text) { store_or_refuse(**option, store, text); },
      help);
  (*option)->type_name(shape);
  return {*option, rules_};
}

Option Command::add_repeated(const std::string& name, const Store& store, const std::string& shape,
                             const std::string& help) const {
  return add_list(
      name, [] {}, store, shape, help, '\0');
}

Option Command::add_list(const std::string& names, const std::function<void()>& clear,
                         const Store& store, const std::string& shape, const std::string& help,
                         char separator) const {
  const auto option = std::make_shared<CLI::Option*>();
  const auto store_all = [option, clear, store](const std::vector<std::string>& texts) {
    clear();
    for (const std::string& text : texts) {
      const auto store_named = [&](const std::string& one) {
        try {
          store(one);
        } catch (const std::invalid_argument& wrong) {
          throw std::invalid_argument(fmt::format("\"{}\": {}", one, wrong.what()));
        }
      };
      store_or_refuse(**option, store_named, text);
    }
  };
  *option = app_->add_option_function<std::vector<std::string>>(names, store_all, help);
  // Positional arguments take all that follow.
  (*option)->type_name(shape)->allow_extra_args(!names.starts_with('-'));
  if (separator != '\0') (*option)->delimiter(separator);
  return {*option, rules_};
}

void Command::when_parsed(std::function<void()> done) const {
  app_->callback([rules = rules_, done = std::move(done)] {
    for (const EffectRule& rule : *rules)
      if (rule.option->count() > 0 && !rule.has_effect())
        throw UsageError(rule.option->get_name(), "has no effect " + rule.why_not);
    done();
  });
}

void Command::refuse_group(const std::string& group, const std::string& reason) const {
  for (const CLI::Option* option : app_->get_options())
    if (option->get_group() == group && option->count() > 0)
      throw UsageError(option->get_name(), reason);
}

std::string Command::name() const { return app_->get_name(); }

std::vector<Command> Command::subcommands() const {
  std::vector<Command> commands;
  for (CLI::App* command : app_->get_subcommands([](const CLI::App*) { return true; }))
    commands.emplace_back(*command);
  return commands;
}

std::string Command::option_names() const {
  std::string words;
  for (const CLI::Option* option : app_->get_options()) {
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
    for (const std::string& name : option->get_snames()) words += "-" + name + " ";
  }
  if (!words.empty()) words.pop_back();
  return words;
}

std::string Command::note(const NumberRange& range, const std::string& default_value) {
  return fmt::format(" ({}; default: {})", range.text(), default_value);
}

std::string Command::number_text(double value) { return fmt::format("{:.6g}", value); }

}  // namespace voxdag::cli
