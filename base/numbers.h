#pragma once
// Converts numbers to text and back, independent of the locale.

#include <optional>
#include <string>
#include <string_view>

namespace softgrip {

/// Returns the shortest text from which `value` can be read exactly. Returns "nan" for NaN and "inf" for
/// infinity.
[[nodiscard]] std::string shortest(double value);
/// Returns the text of shortest(), but without an exponent if the text without exponent is short. Messages
/// show the numbers that are written in files in this form.
[[nodiscard]] std::string written(double value);
/// Returns the number with `digits` significant digits and without trailing zeros. Numbers from 1e-4 to 1e7
/// have no exponent. Returns "-" for NaN or infinity.
[[nodiscard]] std::string significant(double value, int digits = 4);
/// Returns the number with `decimals` digits after the point. Returns "-" for NaN or infinity.
[[nodiscard]] std::string fixed(double value, int decimals);
/// Reads a number from a text. Blanks and tabs around the number and a leading "+" are permitted; any other
/// text gives an empty result.
[[nodiscard]] std::optional<double> to_number(std::string_view text);

}  // namespace softgrip
