#pragma once
// Defines the units in external files and their conversion to the units of a log: s, kPa, mm or deg, and
// degrees Celsius. A bending angle counts as a displacement.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "model/output_unit.h"

namespace softgrip::sysid {

enum class Quantity : std::uint8_t { time, pressure, displacement, temperature };

/// A unit. A value in this unit is factor * value + offset in the unit of a log.
struct Unit {
  std::string_view name;
  Quantity quantity = Quantity::time;
  double factor = 1;
  double offset = 0;
  /// Unit of the displacement in the log if the file states the displacement in this unit.
  model::OutputUnit output = model::OutputUnit::mm;
};

/// Returns the unit of the given quantity with this name: "PSI", "µm", "deg C". Case matters only in mPa and
/// MPa.
[[nodiscard]] std::optional<Unit> unit_named(std::string_view text, Quantity quantity);
/// Returns the unit with this name. The unit can belong to any quantity. Returns nullopt if units of two
/// quantities have this name.
[[nodiscard]] std::optional<Unit> unit_named(std::string_view text);
/// Returns true if the name is a unit of electrical or digital values (V, mA, counts, %). A value in such a
/// unit can be converted to kPa or mm only if the user states a scale.
[[nodiscard]] bool is_raw_unit(std::string_view text);
/// Returns the unit names of a quantity as text for messages: "s, ms, us, ...".
[[nodiscard]] std::string unit_names(Quantity quantity);
/// Returns the name of a quantity: "time", "pressure", ...
[[nodiscard]] std::string_view name_of(Quantity quantity);

/// A column name, split into name and unit. "P [psi]" has the name P and the unit psi, "set_kpa" has the name
/// set and the unit kpa, and "Tip" has no unit.
struct NameAndUnit {
  std::string name;
  std::string unit;  ///< unit as written in the column name; empty: the column name has no unit
};

/// Splits the name of a column into name and unit. A text in brackets is always the unit. After another mark,
/// such as '/' or '_', only a known unit is accepted. If `quantity` is set, the unit must be a unit of this
/// quantity. If `quantity` is not set, a unit that is also a word or a letter must follow a slash or a comma.
/// For example, "in" in "p_in" is not the unit inch.
[[nodiscard]] NameAndUnit split_unit(std::string_view column, std::optional<Quantity> quantity = {});

/// Converts ASCII letters to lower case.
[[nodiscard]] std::string lower_case(std::string_view text);
/// Removes blanks at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace softgrip::sysid
