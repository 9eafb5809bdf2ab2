#pragma once
// Computes indicators of one recorded grip of a finger, relative to its baseline from commissioning.
//
// Free motion before the first contact gives gain and lag, by least squares of the readings on the prediction
// of the baseline model and its rate. The free part of the return gives the loop width. The longest segment
// of free motion with a constant command gives the creep. An indicator is absent if the recording lacks the
// samples for it.

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "model/model.h"
#include "sysid/diagnosis/causes/health_sign.h"
#include "sysid/recordings/recording.h"

namespace softgrip::sysid::health {

/// The baseline of a finger.
struct ScoreBase {
  model::Model model;   ///< driven by the command, without noise
  double full_kpa = 0;  ///< largest command of the healthy logs
  double full_mm = 0;   ///< displacement of the model at `full_kpa`
};
/// Returns the baseline for the scores. @param model  of the baseline. @param full_kpa  > 0.
[[nodiscard]] ScoreBase score_base(const model::Model& model, double full_kpa);

/// Indicators of a run, indexed by HealthNumber. NaN: the recording does not give the indicator.
struct GripScore {
  GripScore() { values.fill(std::numeric_limits<double>::quiet_NaN()); }

  [[nodiscard]] double operator[](sysid::HealthNumber number) const {
    return values[static_cast<std::size_t>(number)];
  }
  double& operator[](sysid::HealthNumber number) { return values[static_cast<std::size_t>(number)]; }

  std::array<double, sysid::health_numbers> values{};
};

/// Computes the indicators of one channel of a recording. A single log without events counts as one free
/// motion.
[[nodiscard]] GripScore score_of(const Recording& recording, std::size_t channel, const ScoreBase& base);

/// Returns the smallest relevant difference of an indicator, regardless of the spread of the runs.
[[nodiscard]] double least_difference(sysid::HealthNumber number, const ScoreBase& base);

}  // namespace softgrip::sysid::health
