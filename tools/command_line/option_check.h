#pragma once
// Checks of options that CLI11 does not provide.

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

#include "base/numbers.h"

namespace softgrip::tools {

/// Accepts a number between `lower` and `upper`, bounds included. Unlike CLI::Range, it refuses NaN.
[[nodiscard]] inline CLI::Validator number_between(double lower, double upper) {
  const std::string range = "a number from " + significant(lower) + " to " + significant(upper);
  const auto check = [=](const std::string& text) {
    const auto value = to_number(text);
    return value && *value >= lower && *value <= upper ? std::string() : "'" + text + "' is not " + range;
  };
  return CLI::Validator(check, "");
}

}  // namespace softgrip::tools
