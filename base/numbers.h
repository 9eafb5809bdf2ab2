#pragma once
// Numbers to text and back, never by locale.

#include <optional>
#include <string>
#include <string_view>

namespace softgrip {

/// The fewest digits that read back to the same double ("nan", "inf" as such).
[[nodiscard]] std::string shortest(double value);
/// The same without an exponent where that is short: for messages that say what a file may hold.
[[nodiscard]] std::string written(double value);
/// `digits` significant ones, for people; no trailing zeros, no exponent from 1e-4 to 1e7; "-" of NaN, inf.
[[nodiscard]] std::string significant(double value, int digits = 4);
/// `decimals` digits after the point; "-" of NaN, inf.
[[nodiscard]] std::string fixed(double value, int decimals);
/// A number that fills the whole text (blanks around it allowed).
[[nodiscard]] std::optional<double> to_number(std::string_view text);

}  // namespace softgrip
