#pragma once
// Tests hypotheses about the static shape of a sensor against readings at known positions.
//
// Every hypothesis predicts reading = S(zero + scale * gauge). Its zero and scale are unknown, and S contains
// the static blocks of the sensor (none: a straight line). Readings and predictions are limited to slightly
// more than the range of the logs, because the logs do not show the sensor beyond it.
//
// The noise is the larger of two values: the scatter of readings at one position, and the noise of the logs
// divided by the root of the samples per reading. The catalogue form only approximates the nonlinearity of
// the sensor, and its parameters come from fits of the whole model. Therefore a comparison of two hypotheses
// permits 20 % of their difference in addition to the noise. A hypothesis is ruled out if the most likely one
// explains the readings (chi-square, 1 in 1000) and is at least 1000 times as likely.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/gauge/gauge_file.h"

namespace softgrip::sysid {

/// Returns the blocks of a model that change the static shape of the sensor, in chain order.
[[nodiscard]] std::vector<model::BlockSpec> static_sensor_blocks(const model::Model& model);

/// A hypothesis about the static shape of the sensor.
struct SensorShape {
  std::vector<model::BlockSpec> blocks;  ///< static_sensor_blocks(); none: straight
  double offset_mm = 0;                  ///< offset of its zero, as fitted to the logs

  /// Returns the reading at a displacement [mm].
  [[nodiscard]] double at(double displacement_mm) const;
  /// "straight", or the ids of its blocks joined by "+".
  [[nodiscard]] std::string id() const;
};

/// Information of the logs about the sensor.
struct GaugeScales {
  double noise_mm = 0;  ///< noise of one sample in the logs
  double lowest_mm = 0;
  double highest_mm = 0;  ///< readings of the logs
};

/// Comparison of one hypothesis with the readings.
struct GaugeFit {
  SensorShape shape;
  double zero_mm = 0;
  double scale = 1;
  std::size_t free = 2;
  std::vector<double> predicted_mm;  ///< for each reading, limited like the readings
  double rms_mm = 0;                 ///< RMS of reading minus prediction, both limited
  /// allowed in addition to the noise in the comparison with the most likely hypothesis
  double tolerance_mm = 0;
  bool explains = false;  ///< the hypothesis explains the readings
  bool ruled_out = false;
  double behind = 0;  ///< log likelihood ratio of the most likely hypothesis over this one
};

enum class GaugeOutcome {
  decided,    ///< at least one hypothesis is ruled out, or there is only one and it fits
  undecided,  ///< the readings fit more than one: too noisy, or not where the hypotheses differ
  /// the readings fit none; a hypothesis that is much worse than another may still be ruled out
  unexplained,
  uncovered,  ///< the readings cover less than half the range of the logs: no hypothesis is tested
};
[[nodiscard]] const char* name_of(GaugeOutcome outcome);

struct GaugeCheck {
  GaugeOutcome outcome = GaugeOutcome::undecided;
  double lower_mm = 0;  ///< limits of the readings
  double upper_mm = 0;
  std::vector<double> cut_mm;  ///< the readings within the limits
  double covered_share = 0;    ///< covered share of the range of the logs' readings
  double repeat_noise_mm = 0;  ///< scatter of repeated readings; 0: no position was repeated
  double noise_mm = 0;         ///< noise that the test used
  std::vector<GaugeFit> fits;  ///< fits in the order of the hypotheses
  std::size_t best = 0;        ///< the most likely one
  /// Log likelihood ratio of the best hypothesis over the next one; 0 with a single hypothesis.
  double log_likelihood_ratio = 0;
  /// The shapes refitted to the readings alone. They describe the nonlinearity of a sensor that fits no
  /// hypothesis.
  GaugeFit straight;
  GaugeFit free_bend;
  GaugeFit free_end;

  /// Distance of the more likely of free_bend and free_end from a straight line [mm, rms and largest], and
  /// its significance.
  struct Departure {
    double rms_mm = 0;
    double largest_mm = 0;
    bool clear = false;
    bool clips = false;
  };
  [[nodiscard]] Departure departure() const;
};

inline constexpr double gauge_log_likelihood_needed = 6.9;  ///< ln 1000

/// Requires at least three positions and at least one hypothesis; no two hypotheses have the same shape.
[[nodiscard]] GaugeCheck check_gauge(const std::vector<GaugeReading>& readings,
                                     const std::vector<SensorShape>& hypotheses, const GaugeScales& scales);

}  // namespace softgrip::sysid
