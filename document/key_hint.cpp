#include "document/reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "base/numbers.h"
#include "document/node.h"

namespace softgrip::document {

namespace {

/// A unit as it appears in keys. `to_base` is the factor from this unit to the unit that the project uses for
/// the same quantity.
struct Unit {
  std::string_view name;
  std::string_view quantity;
  double to_base;
};

constexpr std::array units{
    Unit{"s", "seconds", 1},          Unit{"ms", "seconds", 1e-3},     Unit{"us", "seconds", 1e-6},
    Unit{"ns", "seconds", 1e-9},      Unit{"sec", "seconds", 1},       Unit{"seconds", "seconds", 1},
    Unit{"min", "seconds", 60},       Unit{"h", "seconds", 3600},      Unit{"kpa", "kilopascals", 1},
    Unit{"pa", "kilopascals", 1e-3},  Unit{"mpa", "kilopascals", 1e3}, Unit{"bar", "kilopascals", 100},
    Unit{"mbar", "kilopascals", 0.1}, Unit{"hpa", "kilopascals", 0.1}, Unit{"psi", "kilopascals", 6.894757},
    Unit{"mm", "millimetres", 1},     Unit{"um", "millimetres", 1e-3}, Unit{"cm", "millimetres", 10},
    Unit{"m", "millimetres", 1e3},    Unit{"in", "millimetres", 25.4}, Unit{"inch", "millimetres", 25.4},
    Unit{"hz", "hertz", 1},           Unit{"khz", "hertz", 1e3},       Unit{"v", "volts", 1},
    Unit{"mv", "volts", 1e-3},        Unit{"ma", "milliamperes", 1},   Unit{"a", "milliamperes", 1e3},
    Unit{"ua", "milliamperes", 1e-3}, Unit{"c", "degrees Celsius", 1},
};

const Unit* unit_named(std::string_view name) {
  const auto* const found_unit =
      std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return unit.name == name; });
  return found_unit == units.end() ? nullptr : found_unit;
}

std::vector<std::string_view> words_of(std::string_view key) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t end = key.find('_');
    words.push_back(key.substr(0, end));
    if (end == std::string_view::npos) return words;
    key.remove_prefix(end + 1);
  }
}

/// Returns a number as text for a hint, with at most 9 significant digits: 130 * 0.001 becomes "0.13".
std::string rounded(double number) {
  std::array<char, 32> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, std::chars_format::general, 9).ptr;
  return {buffer.data(), end};
}

/// Returns true if `candidate` is `key` with a unit added, as `delay_s` is `delay` with a unit. All words
/// that `candidate` has in addition must be units of the project or `per`.
bool lacks_unit(std::string_view key, std::string_view candidate) {
  if (candidate.size() <= key.size() + 1 || candidate.substr(0, key.size()) != key ||
      candidate[key.size()] != '_') {
    return false;
  }
  const auto rest = words_of(candidate.substr(key.size() + 1));
  return std::all_of(rest.begin(), rest.end(), [](std::string_view word) {
    const Unit* const unit = unit_named(word);
    return word == "per" || (unit != nullptr && unit->to_base == 1);
  });
}

/// The units of two keys that are equal except for one word. This word is a unit in both keys, and both units
/// measure the same quantity.
struct OtherUnit {
  const Unit* used;
  const Unit* wanted;
  double factor;  // factor that converts a value in the unit `used` to a value in the unit `wanted`
};

std::optional<OtherUnit> other_unit(std::string_view key, std::string_view candidate) {
  const auto used = words_of(key);
  const auto wanted = words_of(candidate);
  if (used.size() != wanted.size()) return std::nullopt;
  std::optional<OtherUnit> difference;
  bool per = false;
  for (std::size_t i = 0; i < used.size(); ++i) {
    per = per || used[i] == "per";
    if (used[i] == wanted[i]) continue;
    const Unit* const from = unit_named(used[i]);
    const Unit* const to = unit_named(wanted[i]);
    if (difference || i == 0 || from == nullptr || to == nullptr || from->quantity != to->quantity) {
      return std::nullopt;
    }
    const double factor = from->to_base / to->to_base;
    difference = OtherUnit{from, to, per ? 1 / factor : factor};
  }
  return difference;
}

std::string other_unit_hint(const OtherUnit& other, const std::string& candidate, const Node& value) {
  std::string hint =
      "unit `" + std::string(other.used->name) + "` is not used here: write `" + candidate + "`";
  if (words_of(candidate).back() == other.wanted->name && other.factor != 1) {
    const auto number = parse_number(value).value;
    const double shown_value = number.value_or(1);
    hint += " in " + std::string(other.wanted->quantity) + " (" + written(shown_value) + " " +
            std::string(other.used->name) + " = " + rounded(shown_value * other.factor) + ")";
  }
  return hint;
}

}  // namespace

KeyHint hint_for_key(std::string_view key, const Node& value, const std::vector<std::string>& known) {
  if (key.size() > 100) return {};
  for (const std::string& candidate : known) {
    if (lacks_unit(key, candidate)) {
      return {candidate, "the unit is missing: did you mean `" + candidate + "`?"};
    }
  }
  for (const std::string& candidate : known) {
    if (const auto other = other_unit(key, candidate)) {
      return {candidate, other_unit_hint(*other, candidate, value)};
    }
  }
  if (const std::size_t colon = key.find(':'); colon != std::string_view::npos) {
    const std::string word(key.substr(0, colon));
    if (std::find(known.begin(), known.end(), word) != known.end()) {
      return {word, "a space is missing after the colon"};
    }
  }
  const std::string near = nearest(key, known);
  if (near.empty()) return {};
  return {near, "did you mean `" + near + "`?"};
}

std::string_view unit_at_end(std::string_view key) {
  constexpr std::array<std::string_view, 7> own{"kpa", "mm", "s", "hz", "v", "ma", "c"};
  const auto words = words_of(key);
  const auto is_unit = [&](std::size_t i) {
    return std::find(own.begin(), own.end(), words[i]) != own.end();
  };
  const std::size_t last = words.size() - 1;
  if (last == 0 || !is_unit(last)) return {};
  std::size_t size = words[last].size();
  if (last > 2 && words[last - 1] == "per" && is_unit(last - 2)) size += words[last - 2].size() + 5;
  return key.substr(key.size() - size);
}

std::string hint_for_range(std::string_view key, double value, double lower, double upper) {
  const Unit* const wanted = unit_named(words_of(key).back());
  if (wanted == nullptr || key.find("_per_") != std::string_view::npos || value == 0) return {};
  // Units that users often write in place of the unit of the key. A hint names no units except these.
  constexpr std::array<std::string_view, 4> usual{"ms", "bar", "m", "ua"};
  for (const std::string_view name : usual) {
    const Unit* const other = unit_named(name);
    if (other->quantity != wanted->quantity) continue;
    const double meant = value * other->to_base / wanted->to_base;
    if (meant >= lower && meant <= upper) {
      return "the unit is " + std::string(wanted->quantity) + ": " + written(value) + " " +
             std::string(name) + " would be " + rounded(meant);
    }
  }
  return {};
}

}  // namespace softgrip::document
