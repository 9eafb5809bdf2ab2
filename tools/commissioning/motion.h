#pragma once
// Checks the valve, the line, the sensor and the model of a finger by a small motion. Also finds swapped
// wires or lines: they are swapped if the sensor of another finger responds to the motion.

#include <cstddef>
#include <span>
#include <vector>

#include "tools/commissioning/examinations.h"

namespace softgrip::tools::doctor {

/// The measurements of a small motion of one finger, from rest and back to rest.
struct Motion {
  double command_kpa = 0;         ///< command at the end of the ramp away from rest [kPa]
  std::vector<ChannelSample> up;  ///< readings of all channels at command_kpa; empty: the channel was not
                                  ///< moved
  double model_mm = 0;            ///< displacement that the model predicts at command_kpa [mm]
  double residual_rms_mm = 0;     ///< RMS difference between reading and model over the complete motion [mm],
                                  ///< both relative to rest
};

[[nodiscard]] MotionSession::Expected<Motion> move_and_watch(const rig::RigFile& rig, MotionSession& session,
                                                             std::size_t channel, const ChannelSample& rest,
                                                             const MoveSettings& settings);
/// Returns true if the displacement of the sensor from rest exceeds two thresholds: a multiple of the
/// sensor's noise, and a share of `model_mm`, the displacement that the model predicts.
[[nodiscard]] bool has_moved(const Sample& rest, const Sample& seen, double model_mm);

/// Reasons why the motion of a channel cannot be checked. An empty text means that the check is possible.
struct NotJudged {
  std::string valve;   ///< reason why the pressure monitor cannot be used to check the valve
  std::string finger;  ///< reason why the finger and its model cannot be checked
};
/// Makes three checks: the pressure follows the command, the sensor shows the motion, and the model predicts
/// the motion. `rest` contains the readings before the motion. `known` contains known problems of the
/// channel. A check that such a problem prevents is reported as not judged.
void judge_motion(const rig::RigFile& rig, std::size_t channel, const ChannelSample& rest,
                  const Motion& motion, const NotJudged& known, Findings& findings);

/// Channels whose wires or lines are swapped in a cycle. When channels[k] was moved, the sensor or pressure
/// monitor of channels[k + 1] responded. When the last of these channels was moved, the first of them
/// responded.
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
/// is the motion of channel i; it is empty if this channel was not moved. `rest` contains the readings before
/// the motions. A motion is evaluated if exactly one sensor or exactly one pressure monitor responded to the
/// motion.
[[nodiscard]] std::vector<Crossing> find_crossings(const rig::RigFile& rig,
                                                   std::span<const ChannelSample> rest,
                                                   std::span<const Motion> motions);

/// Adds one failure per cycle of swapped channels. The advice of the failure names the terminals to swap.
void tell_crossings(const rig::RigFile& rig, std::span<const Crossing> crossings, Findings& findings);

/// Returns true if `channel` belongs to a cycle of swapped channels of the kind `kind`.
[[nodiscard]] bool is_crossed(std::span<const Crossing> crossings, Crossing::Kind kind, std::size_t channel);

}  // namespace softgrip::tools::doctor
