#pragma once
// Converts numbers to text and back, independent of the locale.

#include <optional>
#include <string>
#include <string_view>

namespace softgrip {

/// Returns the shortest text that reads back as the same double ("nan" and "inf" included).
[[nodiscard]] std::string shortest(double value);
/// Returns shortest(), but without an exponent if that is short. Used in messages about values in files.
[[nodiscard]] std::string written(double value);
/// Returns `digits` significant digits without trailing zeros, and without an exponent from 1e-4 to 1e7; "-"
/// for NaN or infinity.
[[nodiscard]] std::string significant(double value, int digits = 4);
/// Returns `decimals` digits after the point; "-" for NaN or infinity.
[[nodiscard]] std::string fixed(double value, int decimals);
/// Reads a number. The text must contain nothing else except blanks around it.
[[nodiscard]] std::optional<double> to_number(std::string_view text);

}  // namespace softgrip
