#pragma once
// Computes indicators of one recorded grip of a finger, relative to its baseline from commissioning.
//
// Free motion before the first contact gives gain and lag, by least squares of the readings on the prediction
// of the baseline model and its rate. The free part of the return gives the loop. The longest segment with a
// constant command gives the creep. Indicators that a recording does not support are absent.

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
  double full_mm = 0;   ///< where the base comes to rest under it
};
/// @param model  of the baseline. @param full_kpa  > 0.
[[nodiscard]] ScoreBase score_base(const model::Model& model, double full_kpa);

/// By HealthNumber; NaN: the recording does not carry it.
struct GripScore {
  GripScore() { values.fill(std::numeric_limits<double>::quiet_NaN()); }

  [[nodiscard]] double operator[](sysid::HealthNumber number) const {
    return values[static_cast<std::size_t>(number)];
  }
  double& operator[](sysid::HealthNumber number) { return values[static_cast<std::size_t>(number)]; }

  std::array<double, sysid::health_numbers> values{};
};

/// Any recording of the daemon, or a log by itself, which is then one free motion.
[[nodiscard]] GripScore score_of(const Recording& recording, std::size_t channel, const ScoreBase& base);

/// Returns the smallest relevant difference of an indicator, regardless of the spread of the runs.
[[nodiscard]] double least_difference(sysid::HealthNumber number, const ScoreBase& base);

}  // namespace softgrip::sysid::health
