#pragma once
/// Subcommands and their options. CLI11 parses; only command.cpp and command_line.cpp include its
/// header, which takes ten seconds to compile.
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "cli/number_range.hpp"
#include "cli/usage_error.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace voxdag::cli {

/// A condition for an option to change the result. An option without effect is an error.
struct EffectRule {
  CLI::Option* option = nullptr;
  std::function<bool()> has_effect;
  std::string why_not;  ///< After "has no effect": "with --no-sun", "without --mesh".
};
using EffectRules = std::vector<EffectRule>;

/// A handle; cheap to copy.
class Option {
 public:
  Option(CLI::Option* option, const std::shared_ptr<EffectRules>& rules)
      : option_(option), rules_(rules) {}

  bool is_given() const;
  std::string name() const;  ///< "--output", or "file" for a positional.

  Option required() const;
  /// Lists the option under this heading of the help.
  Option in_group(const std::string& group) const;
  /// Refuses the option where has_effect() is false once all options are parsed: "has no effect"
  /// and `why_not`. Call it while the Command lives.
  Option only_if(std::function<bool()> has_effect, const std::string& why_not) const;
  /// Refuses the option if `other` is not given.
  Option needs(const Option& other) const;
  /// Refuses the option if `other` is given.
  Option not_with(const Option& other) const;

 private:
  CLI::Option* option_;
  /// The command owns the rules. Rules hold options, so that owning them here would be a cycle.
  std::weak_ptr<EffectRules> rules_;
};

/// A handle of a subcommand, or of the program itself; cheap to copy. The variables that receive
/// option values must live until the command line is parsed.
class Command {
 public:
  explicit Command(CLI::App& app);

  /// Returns a handle whose add() lists subcommands under this heading of the help.
  Command with_heading(const std::string& heading) const;
  /// Adds a subcommand. `purpose` is one line. `footer` is the end of the help: an example, more
  /// examples on lines that begin with two spaces, and notes, one paragraph a line.
  Command add(const std::string& name, const std::string& purpose, const std::string& footer) const;
  /// Passes all arguments that follow, --help among them, to `run` when the command line was
  /// parsed.
  void pass_on(std::function<void(std::vector<std::string>)> run) const;

  /// Adds a text option ("-o,--output") or a text positional ("file").
  Option text(const std::string& names, std::string& value, const std::string& shape,
              const std::string& help) const;
  /// Adds a positional that accepts any number of texts.
  Option texts(const std::string& name, std::vector<std::string>& values, const std::string& shape,
               const std::string& help) const;
  /// Adds a flag that sets `value`.
  Option flag(const std::string& names, bool& value, const std::string& help) const;
  /// Adds a flag that clears `value`.
  Option off_switch(const std::string& name, bool& value, const std::string& help) const;
  /// Adds a number. The help shows its range and its default, which is its current value.
  template <class Number>
  Option number(const std::string& names, Number& value, const NumberRange& range,
                const std::string& shape, const std::string& help) const {
    const auto store = [&value, range](const std::string& text) {
      value = range.parse<Number>(text);
    };
    return add_option(names, store, shape, help + note(range, default_text(value)));
  }
  /// Adds a number without a numeric default; `help` describes the default.
  template <class Number, class Target>
  Option optional_number(const std::string& names, Target& value, const NumberRange& range,
                         const std::string& shape, const std::string& help) const {
    const auto store = [&value, range](const std::string& text) {
      value = range.parse<Number>(text);
    };
    return add_option(names, store, shape, help);
  }
  /// Adds an option whose text is converted by `parse`, which throws std::invalid_argument with the
  /// reason if the text is wrong.
  template <class Value, class Parse>
  Option parsed(const std::string& names, Value& value, const Parse& parse,
                const std::string& shape, const std::string& help) const {
    const auto store = [&value, parse](const std::string& text) { value = parse(text); };
    return add_option(names, store, shape, help);
  }
  /// Adds an option that may be given several times, with one text each.
  template <class Value, class Parse>
  Option repeated(const std::string& name, std::vector<Value>& values, const Parse& parse,
                  const std::string& shape, const std::string& help) const {
    const auto store = [&values, parse](const std::string& text) { values.push_back(parse(text)); };
    return add_repeated(name, store, shape, help);
  }
  /// Adds an option that takes texts separated by commas. The values replace those of `values`.
  template <class Value, class Parse>
  Option list(const std::string& names, std::vector<Value>& values, const Parse& parse,
              const std::string& shape, const std::string& help) const {
    const auto store = [&values, parse](const std::string& text) { values.push_back(parse(text)); };
    return add_list(
        names, [&values] { values.clear(); }, store, shape, help, ',');
  }
  /// Adds an option with an optional whole number: "--name" without a number stores `if_left_out`.
  Option flag_or_number(const std::string& name, int& value, const NumberRange& range,
                        int if_left_out, const std::string& shape, const std::string& help) const;
  /// Adds an option with an optional text: "--name" without a text stores parse(if_left_out).
  template <class Value, class Parse>
  Option flag_or_parsed(const std::string& name, Value& value, const Parse& parse,
                        const std::string& if_left_out, const std::string& shape,
                        const std::string& help) const {
    const Option option = parsed(name, value, parse, shape, help);
    make_optional(name, if_left_out);
    return option;
  }

  /// Registers `done`, which is called after all options of this command were parsed and each of
  /// them was found to have an effect. `done` may throw UsageError.
  void when_parsed(std::function<void()> done) const;
  /// Throws UsageError if an option of the group was given.
  void refuse_group(const std::string& group, const std::string& reason) const;

  std::string name() const;
  std::vector<Command> subcommands() const;
  /// Returns the names of all options, for completion: "--output -o --help -h".
  std::string option_names() const;

 private:
  using Store = std::function<void(const std::string&)>;

  Option add_option(const std::string& names, const Store& store, const std::string& shape,
                    const std::string& help) const;
  Option add_repeated(const std::string& name, const Store& store, const std::string& shape,
                      const std::string& help) const;
  Option add_list(const std::string& names, const std::function<void()>& clear, const Store& store,
                  const std::string& shape, const std::string& help, char separator) const;
  /// Lets an option be given without its text, which then is `if_left_out`.
  void make_optional(const std::string& name, const std::string& if_left_out) const;
  /// Returns the note about range and default: " (1 to 16; default: 4)".
  static std::string note(const NumberRange& range, const std::string& default_value);
  template <class Number>
  static std::string default_text(Number value) {
    if constexpr (std::is_integral_v<Number>)
      return std::to_string(value);
    else
      return number_text(static_cast<double>(value));
  }
  static std::string number_text(double value);

  CLI::App* app_;
  std::shared_ptr<EffectRules> rules_;
  std::string heading_;  ///< Heading of the subcommands that add() adds; empty: the usual one.
};

}  // namespace voxdag::cli
