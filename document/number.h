#pragma once
// Converts texts to numbers. A number must be a plain decimal number; the locale has no effect. For any other
// text, the result contains the reason of the refusal.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "document/node.h"

namespace softgrip::document {

/// A number, or the reason why the text is not a number. Exactly one of `value` and `message` is present.
template <class T>
struct Parsed {
  std::optional<T> value;
  std::string message;  ///< message that follows the key: "must be a number, found `fast`"
  std::string hint;
};

/// Reads a decimal number: [+-]digits[.digits][e[+-]digits]. At least one digit must precede the exponent,
/// and leading zeros are an error.
[[nodiscard]] Parsed<double> parse_number(const Node& node);
/// Reads a whole number: [+-]digits. Leading zeros are an error.
[[nodiscard]] Parsed<std::int64_t> parse_integer(const Node& node);
/// Reads a truth value: `true` or `false`.
[[nodiscard]] Parsed<bool> parse_boolean(const Node& node);

/// Returns "the decimal mark is a point: 0.5" if the comma between two nodes of one line was probably meant
/// as a decimal mark. Examples are `[0,5]` and `{hold_s: 0,5}`. Otherwise returns an empty text. `after` is
/// the location after the comma.
[[nodiscard]] std::string hint_for_comma(const Node& before, Location after, std::string_view text_after);

/// Returns a description of a node that follows "found" in a message: "a list", "a map", "nothing" or
/// "`text`".
[[nodiscard]] std::string found(const Node& node);

}  // namespace softgrip::document
