#pragma once
// Provides the common code of subcommands: the creation of a subcommand, options that several commands share,
// and checks of option values that CLI11 does not provide.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/exit_code.h"
#include "base/numbers.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

/// A subcommand and its options. The subcommand owns the options.
template <class Options>
struct Subcommand {
  CLI::App* command;
  Options* options;
};

/// Adds a subcommand to `program`. If the user chose this subcommand, run(options) is called after the
/// command line was parsed, and the result is stored in `outcome`.
template <class Options>
Subcommand<Options> add_command(CLI::App& program, ExitCode& outcome, const std::string& name,
                                const std::string& about, ExitCode (*run)(const Options&)) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand(name, about);
  command->callback([options, &outcome, run] { outcome = run(*options); });
  return {command, options.get()};
}

/// Adds a subcommand whose function `run` also gets the command's name and arguments (call_of()).
template <class Options>
Subcommand<Options> add_command(CLI::App& program, ExitCode& outcome, const std::string& name,
                                const std::string& about,
                                ExitCode (*run)(const Options&, const std::vector<std::string>& call)) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand(name, about);
  command->callback([options, command, &outcome, run] { outcome = run(*options, call_of(*command)); });
  return {command, options.get()};
}

/// Accepts a number between `lower` and `upper`, bounds included. Unlike CLI::Range, it refuses NaN.
[[nodiscard]] inline CLI::Validator number_between(double lower, double upper) {
  const std::string range = "a number from " + significant(lower) + " to " + significant(upper);
  const auto check = [=](const std::string& text) {
    const auto value = to_number(text);
    return value && *value >= lower && *value <= upper ? std::string() : "'" + text + "' is not " + range;
  };
  return CLI::Validator(check, range);
}

/// Accepts a finite number above 0. Unlike CLI::PositiveNumber, it refuses NaN.
[[nodiscard]] inline CLI::Validator positive_number() {
  const auto check = [](const std::string& text) {
    const auto value = to_number(text);
    return value && std::isfinite(*value) && *value > 0 ? std::string()
                                                        : "'" + text + "' is not a number above 0";
  };
  return CLI::Validator(check, "POSITIVE");
}

/// Accepts a whole number between `lower` and `upper`, bounds included.
[[nodiscard]] inline CLI::Validator whole_between(std::uint64_t lower, std::uint64_t upper) {
  const auto check = [=](const std::string& text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = error == std::errc{} && end == text.data() + text.size();
    return good && value >= lower && value <= upper
               ? std::string()
               : "'" + text + "' is not a whole number from " + std::to_string(lower) + " to " +
                     std::to_string(upper);
  };
  return CLI::Validator(check, "");
}

/// Accepts a seed. CLI11 converts numbers that are negative or too large to other seeds.
[[nodiscard]] inline CLI::Validator seed_number() {
  return whole_between(0, std::numeric_limits<std::uint64_t>::max());
}

/// Adds --seed and --threads to a command that uses random start points and resampling.
template <class Seed, class Threads>
void add_search_options(CLI::App& command, Seed& seed, Threads& threads) {
  command.add_option("--seed", seed, "Seed of the random start points and of the resampling")
      ->check(seed_number())
      ->capture_default_str();
  command.add_option("--threads", threads, "Number of threads; 0: one per core")->capture_default_str();
}

}  // namespace softgrip::tools
