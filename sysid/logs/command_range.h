#pragma once
// Finds single samples whose command is probably wrong.

#include <cstddef>
#include <span>
#include <vector>

namespace softgrip::sysid {

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
