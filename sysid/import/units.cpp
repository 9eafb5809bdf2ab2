#include "sysid/import/units.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "base/enum_table.h"

namespace softgrip::sysid {
namespace {

constexpr double psi_kpa = 6.894757293168361;
constexpr double absolute_zero_c = -273.15;

/// Units that the import can convert. The first unit of each quantity is the unit in a log. The names are in
/// lower case.
constexpr std::array units{
    Unit{"s", Quantity::time},
    Unit{"ms", Quantity::time, 1e-3},
    Unit{"us", Quantity::time, 1e-6},
    Unit{"ns", Quantity::time, 1e-9},
    Unit{"min", Quantity::time, 60},
    Unit{"h", Quantity::time, 3600},
    Unit{"d", Quantity::time, 86400},
    Unit{"kpa", Quantity::pressure},
    Unit{"pa", Quantity::pressure, 1e-3},
    Unit{"hpa", Quantity::pressure, 0.1},
    Unit{"mpa", Quantity::pressure, 1e3},
    Unit{"bar", Quantity::pressure, 100},
    Unit{"mbar", Quantity::pressure, 0.1},
    Unit{"psi", Quantity::pressure, psi_kpa},
    Unit{"atm", Quantity::pressure, 101.325},
    Unit{"mmhg", Quantity::pressure, 0.133322387415},
    Unit{"torr", Quantity::pressure, 101.325 / 760},
    Unit{"inh2o", Quantity::pressure, 0.24908891},
    Unit{"kgf/cm2", Quantity::pressure, 98.0665},
    Unit{"mm", Quantity::displacement},
    Unit{"um", Quantity::displacement, 1e-3},
    Unit{"nm", Quantity::displacement, 1e-6},
    Unit{"cm", Quantity::displacement, 10},
    Unit{"m", Quantity::displacement, 1e3},
    Unit{"in", Quantity::displacement, 25.4},
    Unit{"mil", Quantity::displacement, 0.0254},
    Unit{"deg", Quantity::displacement, 1, 0, model::OutputUnit::deg},
    Unit{"rad", Quantity::displacement, model::deg_per_rad, 0, model::OutputUnit::deg},
    Unit{"mrad", Quantity::displacement, 1e-3 * model::deg_per_rad, 0, model::OutputUnit::deg},
    Unit{"c", Quantity::temperature},
    Unit{"k", Quantity::temperature, 1, absolute_zero_c},
    Unit{"f", Quantity::temperature, 5.0 / 9, -160.0 / 9},
};

struct Spelling {
  std::string_view written;
  std::string_view meant;
};
constexpr std::array spellings{
    Spelling{"sec", "s"},           Spelling{"secs", "s"},
    Spelling{"second", "s"},        Spelling{"seconds", "s"},
    Spelling{"msec", "ms"},         Spelling{"millis", "ms"},
    Spelling{"milliseconds", "ms"}, Spelling{"usec", "us"},
    Spelling{"micros", "us"},       Spelling{"microseconds", "us"},
    Spelling{"nanoseconds", "ns"},  Spelling{"minutes", "min"},
    Spelling{"nsec", "ns"},         Spelling{"nanosec", "ns"},
    Spelling{"hours", "h"},         Spelling{"hr", "h"},
    Spelling{"days", "d"},          Spelling{"psig", "psi"},
    Spelling{"barg", "bar"},        Spelling{"pascal", "pa"},
    Spelling{"millimeter", "mm"},   Spelling{"millimetre", "mm"},
    Spelling{"micron", "um"},       Spelling{"microns", "um"},
    Spelling{"inch", "in"},         Spelling{"inches", "in"},
    Spelling{"meter", "m"},         Spelling{"metre", "m"},
    Spelling{"celsius", "c"},       Spelling{"degc", "c"},
    Spelling{"kelvin", "k"},        Spelling{"degf", "f"},
    Spelling{"fahrenheit", "f"},    Spelling{"degree", "deg"},
    Spelling{"degrees", "deg"},     Spelling{"radian", "rad"},
    Spelling{"radians", "rad"},
};
constexpr std::array<std::string_view, 14> raw_units{
    "v", "mv", "volt", "volts", "ma", "a", "counts", "count", "lsb", "adc", "raw", "%", "percent", "digits"};
/// Names of units that are also words or indices. If the quantity of the column is unknown, such a name
/// counts as a unit only in brackets, or after '/' or ','.
constexpr std::array<std::string_view, 10> doubtful{"in", "min", "a", "c",   "d",
                                                    "f",  "h",   "k", "raw", "count"};

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Returns a unit in lower case, as the table of units spells it. The only case-sensitive unit, mPa, becomes
/// "millipascal".
std::string normalised(std::string_view text) {
  std::string unit(trimmed(text));
  if (unit == "mPa") return "millipascal";
  if (unit == "\xc2\xb0" || unit == "\xc2\xba") return "deg";
  replace_all(unit, "\xc2\xb5", "u");  // the micro sign becomes u
  replace_all(unit, "\xce\xbc", "u");  // the Greek letter mu becomes u
  replace_all(unit, "\xc2\xb0", "");   // the degree sign is removed
  // The ordinal indicator, which is often used as a degree sign, is removed.
  replace_all(unit, "\xc2\xba", "");
  replace_all(unit, " ", "");
  replace_all(unit, "\xc2\xb2", "2");
  replace_all(unit, "^", "");
  unit = lower_case(unit);
  const auto spelt =
      std::find_if(spellings.begin(), spellings.end(), [&](const Spelling& s) { return s.written == unit; });
  return spelt == spellings.end() ? unit : std::string(spelt->meant);
}

bool is_unit_of(std::string_view text, std::optional<Quantity> quantity) {
  if (is_raw_unit(text)) return true;
  return quantity ? unit_named(text, *quantity).has_value() : unit_named(text).has_value();
}

/// Splits a column name with brackets at its end ("P [psi]", "P (psi)") into the name and the text in the
/// brackets.
std::optional<NameAndUnit> in_brackets(std::string_view column) {
  if (column.size() < 3 || (column.back() != ']' && column.back() != ')')) return std::nullopt;
  const std::size_t open = column.rfind(column.back() == ']' ? '[' : '(');
  if (open == std::string_view::npos) return std::nullopt;
  const std::string_view unit = trimmed(column.substr(open + 1, column.size() - open - 2));
  std::string_view name = trimmed(column.substr(0, open));
  while (!name.empty() && (name.back() == '_' || name.back() == ' ')) name.remove_suffix(1);
  // A name such as "M(:,2)" is a column of a matrix and does not end with a unit.
  if (unit.empty() || unit.find(':') != std::string_view::npos) return std::nullopt;
  return NameAndUnit{std::string(name), std::string(unit)};
}

}  // namespace

std::optional<Unit> unit_named(std::string_view text, Quantity quantity) {
  const std::string name = normalised(text);
  if (name == "millipascal" && quantity == Quantity::pressure) return Unit{"mPa", Quantity::pressure, 1e-6};
  const auto found = std::find_if(units.begin(), units.end(), [&](const Unit& unit) {
    return unit.quantity == quantity && unit.name == name;
  });
  if (found == units.end()) return std::nullopt;
  return *found;
}

std::optional<Unit> unit_named(std::string_view text) {
  std::optional<Unit> found;
  for (const Quantity quantity :
       {Quantity::time, Quantity::pressure, Quantity::displacement, Quantity::temperature}) {
    if (const auto unit = unit_named(text, quantity)) {
      if (found) return std::nullopt;
      found = unit;
    }
  }
  return found;
}

bool is_raw_unit(std::string_view text) {
  const std::string unit = normalised(text);
  return std::find(raw_units.begin(), raw_units.end(), unit) != raw_units.end();
}

std::string unit_names(Quantity quantity) {
  std::string names;
  for (const Unit& unit : units) {
    if (unit.quantity == quantity) names += (names.empty() ? "" : ", ") + std::string(unit.name);
  }
  return names;
}

std::string_view name_of(Quantity quantity) {
  static constexpr auto names = enum_names<Quantity>({{Quantity::time, "time"},
                                                      {Quantity::pressure, "pressure"},
                                                      {Quantity::displacement, "displacement"},
                                                      {Quantity::temperature, "temperature"}});
  return names[quantity];
}

NameAndUnit split_unit(std::string_view column, std::optional<Quantity> quantity) {
  column = trimmed(column);
  if (auto bracketed = in_brackets(column)) return *bracketed;
  if (is_unit_of(column, quantity) && column.size() > 1) return {std::string(column), std::string(column)};
  for (const char mark : {'/', ',', ' ', '_', '.', '-'}) {
    const std::size_t at = column.rfind(mark);
    if (at == std::string_view::npos || at == 0 || at + 1 == column.size()) continue;
    const std::string_view unit = trimmed(column.substr(at + 1));
    const bool sure = quantity.has_value() || mark == '/' || mark == ',' ||
                      std::find(doubtful.begin(), doubtful.end(), lower_case(unit)) == doubtful.end();
    if (sure && is_unit_of(unit, quantity))
      return {std::string(trimmed(column.substr(0, at))), std::string(unit)};
  }
  return {std::string(column), {}};
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
    return c < 0x80 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c);
  });
  return lower;
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace softgrip::sysid
