#pragma once
// Defines the output unit: the unit of a finger's sensor, of the readings in a log and of the output of a
// model.
//
// Names in files, JSON and code end with _mm, because most fingers are measured in mm. Nevertheless, their
// values are in the output unit, which may be deg. Texts for the user are converted with in_unit().

#include <array>
#include <numbers>
#include <string>
#include <string_view>

namespace softgrip::model {

enum class OutputUnit {
  mm,
  deg,  ///< the output is a bending angle in degrees
};
inline constexpr std::array all_output_units{OutputUnit::mm, OutputUnit::deg};
inline constexpr double deg_per_rad = 180 / std::numbers::pi;

/// Returns the name of a unit in model files and JSON: "mm" or "deg".
[[nodiscard]] std::string_view name_of(OutputUnit unit) noexcept;

/// Replaces the unit mm in a text of the program by another unit. For deg, "displacement [mm]" becomes
/// "bending angle [deg]", and "mm/kPa" becomes "deg/kPa". Longer words that contain mm, such as "gap_mm", do
/// not change. The text must not contain names that users have chosen.
[[nodiscard]] std::string in_unit(std::string_view text, OutputUnit unit);

}  // namespace softgrip::model
