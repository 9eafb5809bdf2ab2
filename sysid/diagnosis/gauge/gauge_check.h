#pragma once
// Tests hypotheses about the static shape of a sensor against readings at known positions.
//
// Every hypothesis predicts reading = S(zero + scale * gauge) with unknown zero and scale. S contains the
// static blocks of the sensor; without blocks, S is a straight line. Readings and predictions are clipped
// slightly outside the range of the logs, because the logs do not show the sensor beyond that range.
//
// The noise is the larger of two values: the scatter of readings at one position, and the noise of the logs
// divided by the root of the samples per reading. The catalogue form only approximates the nonlinearity of
// the sensor, and its parameters come from fits of the whole model. Therefore a comparison of two hypotheses
// tolerates 20 % of their difference in addition to the noise. A hypothesis is ruled out if the most likely
// hypothesis explains the readings (chi-square, 1 in 1000) and is at least 1000 times as likely.

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
  std::vector<model::BlockSpec> blocks;  ///< static_sensor_blocks(); none: a linear sensor
  double offset_mm = 0;                  ///< offset of the sensor zero, as fitted to the logs

  /// Returns the reading at a displacement [mm].
  [[nodiscard]] double at(double displacement_mm) const;
  /// Returns "straight", or the ids of the blocks joined by "+".
  [[nodiscard]] std::string id() const;
};

/// Noise and range of the readings in the logs.
struct GaugeScales {
  double noise_mm = 0;    ///< noise of one sample in the logs
  double lowest_mm = 0;   ///< lowest reading of the logs
  double highest_mm = 0;  ///< highest reading of the logs
};

/// Comparison of one hypothesis with the readings.
struct GaugeFit {
  SensorShape shape;
  double zero_mm = 0;
  double scale = 1;
  std::size_t free = 2;
  std::vector<double> predicted_mm;  ///< prediction for each reading, clipped like the readings
  double rms_mm = 0;                 ///< RMS of reading minus prediction after clipping
  /// error tolerated in addition to the noise in the comparison with the most likely hypothesis
  double tolerance_mm = 0;
  bool explains = false;  ///< true: the hypothesis explains the readings
  bool ruled_out = false;
  double behind = 0;  ///< logarithm of the likelihood ratio of the most likely hypothesis to this one
};

enum class GaugeOutcome {
  /// at least one hypothesis is ruled out, or the only hypothesis explains the readings
  decided,
  /// several hypotheses explain the readings, which are too noisy or not at the positions where the
  /// hypotheses differ
  undecided,
  /// no hypothesis explains the readings; one that is much worse than another may still be ruled out
  unexplained,
  /// the readings cover less than half of the range of the logs, so no hypothesis is tested
  uncovered,
};
[[nodiscard]] const char* name_of(GaugeOutcome outcome);

struct GaugeCheck {
  GaugeOutcome outcome = GaugeOutcome::undecided;
  double lower_mm = 0;         ///< lower limit at which readings are clipped
  double upper_mm = 0;         ///< upper limit at which readings are clipped
  std::vector<double> cut_mm;  ///< the clipped readings
  double covered_share = 0;    ///< share of the logs' range of readings that the gauge readings cover
  double repeat_noise_mm = 0;  ///< scatter of repeated readings; 0: no position was repeated
  double noise_mm = 0;         ///< noise that the test assumed
  std::vector<GaugeFit> fits;  ///< fits in the order of the hypotheses
  std::size_t best = 0;        ///< index of the most likely hypothesis
  /// Logarithm of the likelihood ratio of the best hypothesis to the next one; 0 with a single hypothesis.
  double log_likelihood_ratio = 0;
  /// Shapes fitted to the gauge readings alone. They describe the nonlinearity of a sensor that no hypothesis
  /// explains.
  GaugeFit straight;
  GaugeFit free_bend;
  GaugeFit free_end;

  /// Deviation of the more likely one of free_bend and free_end from a straight line, and its
  /// significance.
  struct Departure {
    double rms_mm = 0;
    double largest_mm = 0;
    bool clear = false;
    bool clips = false;
  };
  [[nodiscard]] Departure departure() const;
};

inline constexpr double gauge_log_likelihood_needed = 6.9;  ///< ln 1000

/// Tests the hypotheses. Requires at least three positions and at least one hypothesis. The shapes of the
/// hypotheses must differ.
[[nodiscard]] GaugeCheck check_gauge(const std::vector<GaugeReading>& readings,
                                     const std::vector<SensorShape>& hypotheses, const GaugeScales& scales);

}  // namespace softgrip::sysid
