#pragma once
// Finds swapped wires or lines: one finger is moved, and the sensor of another finger responds.

#include <cstddef>
#include <span>
#include <vector>

#include "tools/commissioning/motion.h"

namespace softgrip::tools::doctor {

/// Channels whose wires or lines are swapped in a cycle. When channels[k] was moved, the sensor or pressure
/// monitor of channels[k + 1] responded. When the last channel was moved, the first channel responded.
struct Crossing {
  enum class Kind : std::uint8_t {
    sensors,   ///< the wires of the displacement sensors are swapped
    monitors,  ///< the wires of the pressure monitors are swapped
    valves,    ///< the outputs, or the lines behind the valves, are swapped: sensors and monitors show the
               ///< same cycle
  };
  Kind kind = Kind::sensors;
  std::vector<std::size_t> channels;  ///< indices of the channels, at least two
};

/// Finds the swapped channels from the motions of all channels, which were moved one at a time. `motions[i]`
/// belongs to channel i and is empty if the channel was not moved. `rest` contains the readings before the
/// motions. A motion is evaluated if exactly one sensor or exactly one pressure monitor responded to it.
[[nodiscard]] std::vector<Crossing> find_crossings(const rig::RigFile& rig,
                                                   std::span<const ChannelSample> rest,
                                                   std::span<const Motion> motions);

/// Adds one failure per cycle of swapped channels. Its advice names the terminals to swap.
void tell_crossings(const rig::RigFile& rig, std::span<const Crossing> crossings, Findings& findings);

/// Returns true if `channel` is in a cycle of the given kind.
[[nodiscard]] bool is_crossed(std::span<const Crossing> crossings, Crossing::Kind kind, std::size_t channel);

}  // namespace softgrip::tools::doctor
