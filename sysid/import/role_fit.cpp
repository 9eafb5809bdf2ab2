#include "sysid/import/role_fit.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "sysid/import/units.h"

namespace softgrip::sysid {
namespace {

/// Words that identify a role, in lower case. German words are included, because some data loggers write
/// German column names.
struct Words {
  Role role;
  /// A column whose name contains one of these words as a part has the role.
  std::initializer_list<std::string_view> surely;
};
const std::array<Words, role_count>& words() {
  static const std::array<Words, role_count> list{{
      {Role::time,
       {"time", "t", "zeit", "timestamp", "elapsed", "date", "datetime", "clock", "uhrzeit", "epoch",
        "stamp"}},
      {Role::command,
       {"command", "cmd", "set", "setpoint", "desired", "demand", "target", "ref", "reference", "soll", "sp",
        "pd", "input", "commanded", "sollwert", "valve", "ventil"}},
      {Role::pressure, {"pressure", "press", "p", "druck", "pm", "prs", "regulator"}},
      {Role::displacement,
       {"displacement", "disp",     "x",         "y",          "position",   "pos",     "deflection",
        "stroke",       "tip",      "bend",      "weg",        "laser",      "encoder", "enc",
        "height",       "distance", "extension", "elongation", "travel",     "hub",     "angle",
        "bending",      "theta",    "flexion",   "winkel",     "biegewinkel"}},
      {Role::temperature, {"temperature", "temp", "temperatur"}},
      {Role::supply, {"supply", "tank", "vordruck", "source", "versorgung", "reservoir"}},
  }};
  return list;
}

/// Words for values that are derived from a quantity.
constexpr std::array<std::string_view, 34> derived_words{
    "age",        "error",           "err",          "fehler",      "deviation",
    "abweichung", "regelabweichung", "diff",         "differenz",   "difference",
    "minus",      "residual",        "residuals",    "resid",       "rate",
    "dot",        "deriv",           "derivative",   "speed",       "velocity",
    "vel",        "geschwindigkeit", "acceleration", "slope",       "gradient",
    "std",        "stdev",           "stddev",       "sigma",       "variance",
    "noise",      "rauschen",        "uncertainty",  "unsicherheit"};
/// Words that state a derived value only at the end of a name: "p_dev" is a deviation, but "dev1_p" may be
/// the pressure of a device.
constexpr std::array<std::string_view, 3> derived_endings{"dev", "var", "acc"};

/// Splits a name into lower-case parts: "pSetpoint_kPa[1]" gives p, setpoint, kpa, 1.
std::vector<std::string> parts_of(std::string_view name) {
  std::vector<std::string> parts(1);
  bool was_lower = false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalpha(byte) == 0 && byte < 0x80) {
      if (!parts.back().empty()) parts.emplace_back();
      was_lower = false;
      continue;
    }
    if (std::isupper(byte) != 0 && was_lower) parts.emplace_back();
    parts.back() += c;
    was_lower = std::islower(byte) != 0;
  }
  for (std::string& part : parts) part = lower_case(part);
  return parts;
}

}  // namespace

bool names_derived_value(std::string_view name) {
  std::vector<std::string> parts = parts_of(split_unit(name).name);
  std::erase(parts, std::string());
  const auto is_one_of = [](const auto& words, const std::string& part) {
    return std::find(words.begin(), words.end(), part) != words.end();
  };
  return std::any_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return is_one_of(derived_words, part); }) ||
         (!parts.empty() && is_one_of(derived_endings, parts.back()));
}

bool names_role(std::string_view name, Role role) {
  const std::vector<std::string> parts = parts_of(name);
  const auto& surely = words()[static_cast<std::size_t>(role)].surely;
  return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
    return std::find(surely.begin(), surely.end(), part) != surely.end();
  });
}

std::string stated_unit(const TableColumn& column, std::optional<Quantity> quantity) {
  return column.unit.empty() ? split_unit(column.name, quantity).unit : column.unit;
}

int fitness_for(const TableColumn& column, Role role) {
  const RoleSpec& spec = spec_of(role);
  const bool time = spec.role == Role::time;
  // A column can have a role only if at most 10 % of its cells are unreadable. The import reports the
  // unreadable cells.
  if (column.is_part_of_time) return 0;
  if (column.bad_count * 10 > column.values.size() || (column.moments > 0 && !time)) return 0;
  if (names_derived_value(column.name)) return 0;
  const std::string unit = stated_unit(column, spec.quantity);
  const std::string anywhere = stated_unit(column);
  const bool of_quantity = !unit.empty() && unit_named(unit, spec.quantity).has_value();
  const std::optional<Unit> carried = unit_named(anywhere);
  const std::string bare = split_unit(column.name, spec.quantity).name;
  const bool named = names_role(bare, spec.role);
  const bool angle = carried && carried->output == model::OutputUnit::deg;
  // "temp_deg" is a temperature whose scale is unknown, not an angle.
  const bool warmth = angle && names_role(split_unit(column.name).name, Role::temperature);
  if (warmth) return role == Role::temperature ? 3 : 0;
  const bool elsewhere = !of_quantity && !anywhere.empty() && !is_raw_unit(anywhere) && carried;
  if (elsewhere) return 0;
  if (time && column.moments > 0) return 4;
  // A column of commanded pressure or of supply pressure must not be used as the measured pressure.
  const bool pressure = spec.role == Role::pressure;
  if (pressure && (names_role(bare, Role::command) || names_role(bare, Role::supply))) return 0;
  if (spec.role == Role::command && names_role(bare, Role::displacement) && !of_quantity) return 0;
  // A column of a displacement in mm gets a higher score than a column of an angle.
  if (named) return !of_quantity ? 3 : angle ? 4 : 5;
  const bool by_unit_alone = pressure || spec.role == Role::displacement || time;
  return !of_quantity || !by_unit_alone ? 0 : angle ? 1 : 2;
}

}  // namespace softgrip::sysid
