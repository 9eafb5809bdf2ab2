#pragma once
// Checks that protect the fingers and a held part during a motion by hand.

#include <cstddef>
#include <optional>
#include <string>

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools {

/// Returns true if a finger may hold a part. The part could drop, because a command without softgripd writes
/// the rest pressures to the board even if no finger is moved.
[[nodiscard]] bool may_hold_a_part(const rig::RigFile& rig);

/// Returns true if a measured pressure [kPa] is outside the pressure limits of the channel. The tolerance is
/// `pressure_tolerance_kpa` of the rig file, and at least 1 kPa. Returns false if the pressure is not a
/// number.
[[nodiscard]] bool pressure_beyond(const rig::RigFile& rig, std::size_t channel, double pressure_kpa);

/// Describes a pressure outside the limits: "72.5 kPa; the limits are 0 to 60 kPa".
[[nodiscard]] std::string beyond_text(const rig::RigFile& rig, std::size_t channel, double pressure_kpa);

/// A pressure that a person has read from a manometer.
struct ManometerReading {
  double command_kpa = 0;  ///< commanded pressure during the reading
  double shown_kpa = 0;    ///< reading of the manometer
  double next_kpa = 0;     ///< command of the other position
};

/// Returns the reason why the valve must not be commanded to `next_kpa`, or nothing. The pressure at
/// `next_kpa` is estimated from the reading and from the rest pressure. The reading counts as uncertain by
/// 1 kPa.
[[nodiscard]] std::optional<std::string> refusal_of(const rig::RigFile& rig, std::size_t channel,
                                                    const ManometerReading& reading);

}  // namespace softgrip::tools
