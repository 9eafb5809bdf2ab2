#pragma once
// Finds single samples whose command is probably wrong, and states when commands count as equal or different.

#include <cstddef>
#include <span>
#include <vector>

namespace softgrip::sysid {

/// Two commands are different if their distance exceeds this share of the range of the commands. Errors of a
/// regulator and of a pressure sensor are smaller than this share.
inline constexpr double different_command_share = 0.1;
/// Largest change of a drive that counts as constant, as a share of the largest drive or of the range of the
/// commands. The noise and the resolution of a pressure are smaller than this share.
inline constexpr double steady_drive_share = 0.01;

/// Range of the commands of a log without its excursions.
struct CommandRange {
  double lowest_kpa = 0;
  double highest_kpa = 0;
  /// Indices of the excursions in ascending order. An excursion is a single sample that fulfils two
  /// conditions. The two samples before it and the two samples after it differ among each other by at most 10
  /// % of its height. The command of this sample is outside the range of all other samples by more than 10 %
  /// of this range.
  std::vector<std::size_t> excursions;
};

/// Returns the range and the excursions of a command. A real command can contain such a pulse, so callers
/// must not remove an excursion. If all other samples have the same command, no sample is an excursion,
/// because the pulses are then the excitation.
/// @param command_kpa  at least one finite command.
[[nodiscard]] CommandRange command_range(std::span<const double> command_kpa);

}  // namespace softgrip::sysid
