#pragma once
// Checks of option values that CLI11 does not provide.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>

#include "base/numbers.h"

namespace softgrip {

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

}  // namespace softgrip
