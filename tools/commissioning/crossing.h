#pragma once
// SharedState that were swapped: when one finger was moved, another one's sensor showed it.

#include <cstddef>
#include <span>
#include <vector>

#include "tools/commissioning/motion.h"

namespace softgrip::tools::doctor {

/// Channels whose wires of one kind go round in a circle: when channels[k] was moved, what belongs to
/// channels[k + 1] showed it, and of the last one what belongs to the first.
struct Crossing {
  enum class Kind : std::uint8_t {
    sensors,   ///< displacement
    monitors,  ///< pressure
    valves,    ///< both of them show the same circle: the outputs, or the lines behind the valves
  };
  Kind kind = Kind::sensors;
  std::vector<std::size_t> channels;  ///< at least two
};

/// The circles in what was seen when every channel was moved by itself; `motions[i]` is channel i's (one that
/// was not moved shows nothing), `rest` what all read before. A channel counts where exactly one sensor, or
/// one monitor, followed it.
[[nodiscard]] std::vector<Crossing> find_crossings(const rig::RigFile& rig,
                                                   std::span<const ChannelSample> rest,
                                                   std::span<const Motion> motions);

/// One failure per circle, which names the terminals to swap.
void tell_crossings(const rig::RigFile& rig, std::span<const Crossing> crossings, Findings& findings);

/// Whether a channel is in a circle of that kind.
[[nodiscard]] bool is_crossed(std::span<const Crossing> crossings, Crossing::Kind kind, std::size_t channel);

}  // namespace softgrip::tools::doctor
