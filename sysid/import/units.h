#pragma once
// Units in external files, and their conversion to the units of a log: s, kPa, mm or deg, degrees Celsius. A
// bending angle counts as a displacement.

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
  /// Output unit of a log whose displacement is in this unit.
  model::OutputUnit output = model::OutputUnit::mm;
};

/// Returns the unit of a quantity that a text names: "PSI", "µm", "deg C". Case is ignored, except in mPa and
/// MPa.
[[nodiscard]] std::optional<Unit> unit_named(std::string_view text, Quantity quantity);
/// Returns the unit of any quantity that a text names; nullopt if two quantities have a unit of this name.
[[nodiscard]] std::optional<Unit> unit_named(std::string_view text);
/// Returns true for units of electrical or digital values (V, mA, counts, %). Such values need a scale to
/// become kPa or mm.
[[nodiscard]] bool is_raw_unit(std::string_view text);
/// Returns the names of the units of a quantity for messages: "s, ms, us, ...".
[[nodiscard]] std::string unit_names(Quantity quantity);
/// Returns the name of a quantity: "time", "pressure", ...
[[nodiscard]] std::string_view name_of(Quantity quantity);

/// The name of a column, split into name and unit: "P [psi]" is P in psi, "set_kpa" is set in kpa, and "Tip"
/// has no unit.
struct NameAndUnit {
  std::string name;
  std::string unit;  ///< as written; empty: none
};

/// Splits the name of a column into name and unit. A text in brackets is always the unit. After another mark,
/// such as '/' or '_', only a known unit of `quantity` is accepted, or of any quantity if none is given. If
/// no quantity is given, a unit that is also a word or a letter needs a slash or a comma before it (p_in is
/// not in inches).
[[nodiscard]] NameAndUnit split_unit(std::string_view column, std::optional<Quantity> quantity = {});

/// Converts ASCII letters to lower case.
[[nodiscard]] std::string lower_case(std::string_view text);
/// Removes blanks at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace softgrip::sysid
