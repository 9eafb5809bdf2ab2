#pragma once
// Units that people write, and how to come from them to the units of a log: s, kPa, mm or deg, degrees
// Celsius. A bending angle is a displacement, too.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "model/output_unit.h"

namespace softgrip::sysid {

enum class Quantity : std::uint8_t { time, pressure, displacement, temperature };

/// In the unit of a log, a value in this unit is factor * value + offset.
struct Unit {
  std::string_view name;
  Quantity quantity = Quantity::time;
  double factor = 1;
  double offset = 0;
  /// Of a displacement: what a log is in that holds it.
  model::OutputUnit output = model::OutputUnit::mm;
};

/// The unit of a quantity that a text names: "PSI", "µm", "deg C". Upper and lower case are one but for mPa
/// and MPa.
[[nodiscard]] std::optional<Unit> unit_named(std::string_view text, Quantity quantity);
/// The same where the quantity is open; a text that two quantities know names none.
[[nodiscard]] std::optional<Unit> unit_named(std::string_view text);
/// True for what a converter delivers (V, mA, counts, %): without a scale it says nothing of kPa or mm.
[[nodiscard]] bool is_raw_unit(std::string_view text);
/// "s, ms, us, ...": for messages.
[[nodiscard]] std::string unit_names(Quantity quantity);
/// "time", "pressure", ...
[[nodiscard]] std::string_view name_of(Quantity quantity);

/// What a column's name says: "P [psi]" is P in psi, "set_kpa" is set in kpa, "Tip" is Tip in nothing.
struct NameAndUnit {
  std::string name;
  std::string unit;  ///< as written; empty: none
};

/// In brackets or behind a slash anything is the unit. Behind a blank or an underscore only what is surely
/// one: with a quantity its units, without it those that are no word or letter of their own (p_in is no
/// inch).
[[nodiscard]] NameAndUnit split_unit(std::string_view column, std::optional<Quantity> quantity = {});

/// Lower-case, of ASCII letters alone.
[[nodiscard]] std::string lower_case(std::string_view text);
/// Without blanks at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace softgrip::sysid
