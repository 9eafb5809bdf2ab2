#pragma once
// Computes the indicators of one recorded grip of a finger, relative to its baseline from commissioning.
//
// Gain and lag are computed from rest and from free motion towards larger displacements, by least squares of
// the readings on the prediction of the baseline model and its rate. The loop width is computed from the part
// of the return that is free motion. The creep is computed from the longest segment of free motion with a
// constant command. An indicator is absent if the recording lacks the samples for this indicator.
//
// Divides a recorded grip into rest, free motion and holding. The indicators of the finger are computed from
// the free motion. The indicators of its pressure line are computed from the time in which the finger holds
// an object. All other samples are not scored.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/health_sign.h"
#include "sysid/recordings/recording.h"

namespace softgrip::sysid::health {

/// Baseline of a finger, to which its grips are compared.
struct ScoreBase {
  model::Model model;   ///< baseline model; its input is the command, and it contains no noise
  double full_kpa = 0;  ///< largest command of the healthy logs
  double full_mm = 0;   ///< displacement of the model at `full_kpa`
};
/// Returns the baseline for the scores.
/// @param model  baseline model.
/// @param full_kpa  full pressure, > 0 [kPa].
[[nodiscard]] ScoreBase score_base(const model::Model& model, double full_kpa);

/// Indicators of a run, indexed by HealthNumber. NaN: the indicator cannot be computed from the recording.
struct GripScore {
  GripScore() { values.fill(std::numeric_limits<double>::quiet_NaN()); }

  [[nodiscard]] double operator[](sysid::HealthNumber number) const {
    return values[static_cast<std::size_t>(number)];
  }
  double& operator[](sysid::HealthNumber number) { return values[static_cast<std::size_t>(number)]; }

  std::array<double, sysid::health_numbers> values{};
};

/// Computes the indicators of one channel of a recording. A recording without events counts as one free
/// motion.
[[nodiscard]] GripScore score_of(const Recording& recording, std::size_t channel, const ScoreBase& base);

/// Returns the lower limit of the standard deviation of an indicator. With this limit, a negligible
/// difference does not count as a change, however little the runs differ.
[[nodiscard]] double least_difference(sysid::HealthNumber number, const ScoreBase& base);

enum class Part : std::uint8_t {
  /// samples that are neither rest, free motion nor HOLDING, for example in contact before HOLDING, or after
  /// a fault
  neither,
  rest,  ///< samples before the first motion of the finger
  free,  ///< samples in free motion
  held,  ///< samples in HOLDING whose command is still the command at the start of HOLDING
};

struct GripParts {
  std::vector<Part> at;  ///< part of the grip to which each sample belongs
  /// Times of events [s]; NaN if the recording has no such event.
  double began_s = std::numeric_limits<double>::quiet_NaN();    ///< time of the first step of the sequence
  double contact_s = std::numeric_limits<double>::quiet_NaN();  ///< time of the first contact
  double holding_s = std::numeric_limits<double>::quiet_NaN();  ///< time of the first HOLDING
};

/// Assigns each sample of a channel to a part of the grip.
/// @param predicted_mm  predicted free motion of each sample.
/// @param full_kpa  full pressure of the finger, > 0. The finger is at rest until the command has risen by
/// 0.5 % of `full_kpa`. During HOLDING, a command change by up to 2 % of `full_kpa` is ignored.
/// @param full_mm  displacement of the finger at `full_kpa`, > 0. After HOLDING, the finger is in free motion
/// again when its reading is below the reading at contact by 5 % of `full_mm`, and by 10 % of this reading.
[[nodiscard]] GripParts parts_of(const Recording& recording, std::size_t channel,
                                 const std::vector<double>& predicted_mm, double full_kpa, double full_mm);

}  // namespace softgrip::sysid::health
