#pragma once
/// One option or positional of a subcommand.
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class Option;
}

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

}  // namespace voxdag::cli
