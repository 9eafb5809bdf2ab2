#include "sysid/logs/command_range.h"

#include <algorithm>
#include <cmath>

namespace softgrip::sysid {
namespace {

/// Largest difference between the samples around an excursion, relative to its height. At the peak of a
/// triangle or of a sine, this ratio is at least 1.
constexpr double agreement = 0.1;

/// Returns true if one sample differs from the samples on both sides, and these samples agree.
bool leaves_for_one_sample(std::span<const double> command, std::size_t at) {
  const double height = std::abs(command[at] - (command[at - 1] + command[at + 1]) / 2);
  double change = std::abs(command[at + 1] - command[at - 1]);
  if (at >= 2) change = std::max(change, std::abs(command[at - 1] - command[at - 2]));
  if (at + 2 < command.size()) change = std::max(change, std::abs(command[at + 2] - command[at + 1]));
  return height > 0 && change <= agreement * height;
}

}  // namespace

CommandRange command_range(std::span<const double> command_kpa) {
  std::vector<std::size_t> pulses;
  for (std::size_t i = 1; i + 1 < command_kpa.size(); ++i) {
    if (leaves_for_one_sample(command_kpa, i)) pulses.push_back(i);
  }
  CommandRange range{command_kpa.front(), command_kpa.front(), {}};
  const auto include = [&](double command) {
    range.lowest_kpa = std::min(range.lowest_kpa, command);
    range.highest_kpa = std::max(range.highest_kpa, command);
  };
  auto pulse = pulses.begin();
  for (std::size_t i = 0; i < command_kpa.size(); ++i) {
    if (pulse != pulses.end() && *pulse == i) {
      ++pulse;
    } else {
      include(command_kpa[i]);
    }
  }
  const double width = range.highest_kpa - range.lowest_kpa;
  const double lowest = range.lowest_kpa - different_command_share * width,
               highest = range.highest_kpa + different_command_share * width;
  for (const std::size_t i : pulses) {
    if (width > 0 && (command_kpa[i] < lowest || command_kpa[i] > highest)) {
      range.excursions.push_back(i);
    } else {
      include(command_kpa[i]);
    }
  }
  return range;
}

}  // namespace softgrip::sysid
