#include "document/node.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace softgrip::document {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The parts of a decimal number.
struct Decimal {
  std::string_view digits;  // the number as text for from_chars(), without a leading +
  std::string_view whole;   // digits of the number before the decimal point
  bool fraction = false;
  bool exponent = false;
};

std::size_t count_digits(std::string_view text) {
  const auto* const end = std::find_if_not(text.begin(), text.end(), is_digit);
  return static_cast<std::size_t>(end - text.begin());
}

std::optional<Decimal> split(std::string_view text) {
  Decimal decimal;
  // from_chars() does not accept a leading plus sign.
  decimal.digits = text.starts_with('+') ? text.substr(1) : text;
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  const std::size_t whole = count_digits(text);
  decimal.whole = text.substr(0, whole);
  text.remove_prefix(whole);
  std::size_t fraction = 0;
  if (!text.empty() && text[0] == '.') {
    decimal.fraction = true;
    fraction = count_digits(text.substr(1));
    text.remove_prefix(1 + fraction);
  }
  if (whole + fraction == 0) return std::nullopt;
  if (!text.empty() && (text[0] == 'e' || text[0] == 'E')) {
    decimal.exponent = true;
    text.remove_prefix(1);
    if (!text.empty() && (text[0] == '+' || text[0] == '-')) text.remove_prefix(1);
    const std::size_t exponent = count_digits(text);
    if (exponent == 0) return std::nullopt;
    text.remove_prefix(exponent);
  }
  if (!text.empty()) return std::nullopt;
  return decimal;
}

bool leading_zero(const Decimal& decimal) {
  return decimal.whole.size() > 1 && decimal.whole[0] == '0';
}

std::string lower(std::string_view text) {
  std::string out(text.substr(0, 16));
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

bool one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Replaces each `from` in the text by `to`, to remove separators of digits or to change the decimal mark.
/// Returns the new text, or an empty text if the new text is not a number.
std::string repaired(std::string_view text, char from, std::string_view to) {
  if (text.find(from) == std::string_view::npos) return {};
  std::string out;
  for (const char c : text) {
    if (c == from) {
      out += to;
    } else {
      out += c;
    }
  }
  return split(out) ? out : std::string{};
}

/// Returns a hint about the probable meaning of a text that is not a decimal number.
std::string hint_for(std::string_view text) {
  const std::string word = lower(text);
  if (one_of(word, {".nan", ".inf", "-.inf", "+.inf", "nan", "inf", "-inf", "+inf", "infinity"})) {
    return "only finite numbers are allowed";
  }
  if (word.starts_with("0x") || word.starts_with("0o") || word.starts_with("0b")) {
    return "write the number in decimal";
  }
  if (one_of(word, {"yes", "no", "on", "off", "true", "false"}))
    return "a number is needed here, not a boolean";
  if (const std::string plain = repaired(text, '_', ""); !plain.empty()) return "write " + plain;
  if (const std::string point = repaired(text, ',', "."); !point.empty()) {
    return "the decimal mark is a point: " + point;
  }
  std::size_t number = text.size();
  while (number > 0 && !is_digit(text[number - 1]) && text[number - 1] != '.') --number;
  if (number > 0 && number < text.size() && split(text.substr(0, number))) {
    return "write the number without a unit, because the key contains the unit";
  }
  return {};
}

template <class T>
Parsed<T> refused(std::string message, std::string hint) {
  return {std::nullopt, std::move(message), std::move(hint)};
}

/// Returns the parts of the decimal number in a node. If the node does not contain a decimal number, stores
/// the reason in `out`.
template <class T>
std::optional<Decimal> decimal_of(const Node& node, std::string_view wanted, Parsed<T>& out) {
  const std::string must = "must be " + std::string(wanted) + ", found ";
  if (node.kind != Node::Kind::scalar) {
    out = refused<T>(must + found(node), "");
    return std::nullopt;
  }
  const auto decimal = split(node.scalar);
  if (node.quoted) {
    out = refused<T>(must + "the text " + found(node) + " in quotes", decimal ? "remove the quotes" : "");
    return std::nullopt;
  }
  if (!decimal) {
    out = refused<T>(must + found(node), hint_for(node.scalar));
    return std::nullopt;
  }
  if (leading_zero(*decimal)) {
    out = refused<T>(must + found(node),
                     "a number with a leading zero could be read as octal: remove the zero");
    return std::nullopt;
  }
  return decimal;
}

}  // namespace

std::string found(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "nothing";
    case Node::Kind::sequence:
      return "a list";
    case Node::Kind::map:
      return "a map";
    case Node::Kind::scalar:
      break;
  }
  if (node.scalar.empty()) return "an empty text";
  return in_backticks(node.scalar) +
         (node.stands_for.empty() ? "" : " (" + in_backticks(node.stands_for) + ")");
}

std::string hint_for_comma(const Node& before, Location after, std::string_view text_after) {
  const auto decimal =
      before.kind == Node::Kind::scalar && !before.quoted ? split(before.scalar) : std::nullopt;
  const bool whole = decimal && !decimal->fraction && !decimal->exponent;
  const bool digits = !text_after.empty() && count_digits(text_after) == text_after.size();
  const bool glued = before.at.line == after.line &&
                     after.column == before.at.column + static_cast<int>(before.scalar.size()) + 1;
  if (!whole || !digits || !glued) return {};
  return "the decimal mark is a point: " + before.scalar + "." + std::string(text_after);
}

Parsed<double> parse_number(const Node& node) {
  Parsed<double> out;
  const auto decimal = decimal_of(node, "a number", out);
  if (!decimal) return out;
  double value = 0;
  const char* const end = decimal->digits.data() + decimal->digits.size();
  if (std::from_chars(decimal->digits.data(), end, value).ec == std::errc{}) {
    out.value = value;
    return out;
  }
  return refused<double>("is " + found(node) + ", too large or too close to zero for a number", "");
}

Parsed<std::int64_t> parse_integer(const Node& node) {
  Parsed<std::int64_t> out;
  const auto decimal = decimal_of(node, "a whole number", out);
  if (!decimal) return out;
  if (decimal->fraction || decimal->exponent) {
    return refused<std::int64_t>("must be a whole number, found " + found(node),
                                 "write the number without decimal point and without exponent");
  }
  std::int64_t value = 0;
  const char* const end = decimal->digits.data() + decimal->digits.size();
  if (std::from_chars(decimal->digits.data(), end, value).ec == std::errc{}) {
    out.value = value;
    return out;
  }
  return refused<std::int64_t>("is " + found(node) + ", too large for a whole number", "");
}

Parsed<bool> parse_boolean(const Node& node) {
  const std::string must = "must be `true` or `false`, found ";
  if (node.kind != Node::Kind::scalar) return refused<bool>(must + found(node), "");
  const std::string word = lower(node.scalar);
  if (node.quoted) {
    return refused<bool>(must + "the text " + found(node) + " in quotes",
                         one_of(word, {"true", "false"}) ? "remove the quotes" : "");
  }
  if (node.scalar == "true") return {true, "", ""};
  if (node.scalar == "false") return {false, "", ""};
  if (one_of(word, {"yes", "on", "true", "y", "1"})) return refused<bool>(must + found(node), "write `true`");
  if (one_of(word, {"no", "off", "false", "n", "0"}))
    return refused<bool>(must + found(node), "write `false`");
  return refused<bool>(must + found(node), "");
}

}  // namespace softgrip::document
