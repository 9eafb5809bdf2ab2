#pragma once
// Checks the valve, the line, the sensor and the model of a finger by a small motion, and finds swapped wires
// or lines: one finger is moved, and the sensor of another finger responds.

#include <cstddef>
#include <span>
#include <vector>

#include "tools/commissioning/examinations.h"

namespace softgrip::tools::doctor {

/// The measurements of a small motion of one finger, from rest and back to rest.
struct Motion {
  double command_kpa = 0;         ///< command at the end of the ramp away from rest [kPa]
  std::vector<ChannelSample> up;  ///< readings of all channels at this command; empty: the channel was not
                                  ///< moved
  double model_mm = 0;            ///< displacement that the model predicts at this command [mm]
  double residual_rms_mm = 0;     ///< RMS difference between reading and model over the whole motion, both
                                  ///< relative to rest
};

[[nodiscard]] MotionSession::Expected<Motion> move_and_watch(const rig::RigFile& rig, MotionSession& session,
                                                             std::size_t channel, const ChannelSample& rest,
                                                             const MoveSettings& settings);
/// Returns true if the displacement of the sensor from rest exceeds two thresholds: a multiple of its noise,
/// and a share of `model_mm`, the displacement that the model predicts.
[[nodiscard]] bool has_moved(const Sample& rest, const Sample& seen, double model_mm);

/// Reasons why the motion of a channel cannot be checked. An empty text means that the check is possible.
struct NotJudged {
  std::string valve;   ///< reason why the pressure monitor cannot check the valve
  std::string finger;  ///< reason why the finger and its model cannot be checked
};
/// Checks that the pressure follows the command, that the sensor shows the motion, and that the model
/// predicts it. `rest` contains the readings before the motion. `known` contains known problems; a check that
/// depends on one of them is reported as not judged.
void judge_motion(const rig::RigFile& rig, std::size_t channel, const ChannelSample& rest,
                  const Motion& motion, const NotJudged& known, Findings& findings);

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
