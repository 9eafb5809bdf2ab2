#pragma once
// Texts to numbers: plain decimal only, independent of the locale, and what to say of anything else.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "document/node.h"

namespace softgrip::document {

/// A number, or why the text is none. Exactly one of `value` and `message` is there.
template <class T>
struct Parsed {
  std::optional<T> value;
  std::string message;  ///< goes on after "`key` ": "must be a number, found `fast`"
  std::string hint;
};

/// [+-]digits[.digits][e[+-]digits], at least one digit before the exponent, no leading zeros.
[[nodiscard]] Parsed<double> parse_number(const Node& node);
/// [+-]digits, no leading zeros.
[[nodiscard]] Parsed<std::int64_t> parse_integer(const Node& node);
/// `true` or `false`.
[[nodiscard]] Parsed<bool> parse_boolean(const Node& node);

/// Returns "the decimal mark is a point: 0.5" if a comma between two nodes of one line was probably a decimal
/// mark, as in `[0,5]` and `{hold_s: 0,5}`; or empty. `after` is the location behind the comma.
[[nodiscard]] std::string hint_for_comma(const Node& before, Location after, std::string_view text_after);

/// Returns the kind of a node, for "found ...": "a list", "a map", "nothing", "`text`".
[[nodiscard]] std::string found(const Node& node);

}  // namespace softgrip::document
