#pragma once
// The unit of a finger's sensor. The readings in a log and the output of a model have this unit.
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

/// Returns "mm" or "deg", which are the words in model files and JSON.
[[nodiscard]] std::string_view name_of(OutputUnit unit) noexcept;

/// Converts a text of the program from mm to another unit. For deg, "displacement [mm]" becomes "bending
/// angle [deg]", and "mm/kPa" becomes "deg/kPa". Longer words that contain mm, such as "gap_mm", do not
/// change. The text must not contain names that users have chosen.
[[nodiscard]] std::string in_unit(std::string_view text, OutputUnit unit);

}  // namespace softgrip::model
