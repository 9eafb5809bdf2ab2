#pragma once
// The unit of what the sensor of a finger reads: of the readings of a log, and of the answer of a model.
//
// Names in files, JSON and code end with _mm, because most fingers are measured in mm. Their values are in
// the output unit, which may be deg. Texts for people use in_unit().

#include <array>
#include <numbers>
#include <string>
#include <string_view>

namespace softgrip::model {

enum class OutputUnit {
  mm,
  deg,  ///< of a bending angle
};
inline constexpr std::array all_output_units{OutputUnit::mm, OutputUnit::deg};
inline constexpr double deg_per_rad = 180 / std::numbers::pi;

/// "mm", "deg": the word of a model file and of JSON.
[[nodiscard]] std::string_view name_of(OutputUnit unit) noexcept;

/// A text of the program that speaks of mm, in this unit: of deg, "displacement [mm]" becomes "bending angle
/// [deg]", "mm/kPa" becomes "deg/kPa". Words that only contain these, as "gap_mm", stay. Names that users
/// gave must not come in here.
[[nodiscard]] std::string in_unit(std::string_view text, OutputUnit unit);

}  // namespace softgrip::model
