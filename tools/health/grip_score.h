#pragma once
// A recorded grip of one finger as a few numbers, each against the base: what the finger did when it was
// commissioned.
//
// Free motion before the first touch gives gain and lag, by least squares of the readings on what the base
// predicts and how fast that moves; the way back, where it is free again, gives the loop; the longest stretch
// in which the command stands still gives the creep. What a recording does not carry is absent.

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "model/model.h"
#include "sysid/diagnosis/causes/health_sign.h"
#include "tools/recordings/recording.h"

namespace softgrip::tools::health {

/// What the finger is compared with.
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

/// Smaller differences of a number are worth nobody's while, however alike the runs are.
[[nodiscard]] double least_difference(sysid::HealthNumber number, const ScoreBase& base);

}  // namespace softgrip::tools::health
