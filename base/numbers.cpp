#include "base/numbers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace softgrip {
namespace {

template <class... Format>
std::string formatted(double value, Format... format) {
  std::array<char, 512> buffer;  // in fixed notation, the longest double has 309 digits before the decimal
                                 // point
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format...);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::string("?");
}

std::string without_trailing_zeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

}  // namespace

std::string shortest(double value) {
  return formatted(value);
}

std::string written(double value) {
  constexpr std::size_t short_enough = 10;
  std::string text = formatted(value, std::chars_format::fixed);
  return text.size() <= short_enough ? text : shortest(value);
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  const double magnitude = std::abs(value);
  if (magnitude < 1e-4 || magnitude >= 1e7) {
    const std::string text = formatted(value, std::chars_format::scientific, digits - 1);
    const std::size_t exponent = text.find('e');
    return without_trailing_zeros(text.substr(0, exponent)) + text.substr(exponent);
  }
  const int leading = static_cast<int>(std::floor(std::log10(magnitude)));
  return without_trailing_zeros(
      formatted(value, std::chars_format::fixed, std::max(0, digits - 1 - leading)));
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::string text = formatted(value, std::chars_format::fixed, decimals);
  const bool only_zeros = text.find_first_not_of("-0.") == std::string::npos;
  if (only_zeros && text.front() == '-') text.erase(0, 1);
  return text;
}

std::optional<double> to_number(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return std::nullopt;
  text = text.substr(first, text.find_last_not_of(blanks) - first + 1);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace softgrip
