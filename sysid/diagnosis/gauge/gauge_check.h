#pragma once
// Tests hypotheses about the static shape of a sensor against readings at known positions.
//
// Every hypothesis predicts reading = S(zero + scale * gauge) with unknown zero and scale. The function S
// consists of the static blocks of the sensor; if there are no such blocks, S is a straight line. Readings
// and predictions are clipped slightly outside the range of the readings in the logs, because the logs do not
// show how the sensor behaves beyond this range.
//
// The noise is the larger of two values: the scatter of readings at one position, and the noise of the logs
// divided by the root of the samples per reading. The catalogue form only approximates the nonlinearity of
// the sensor, and its parameters come from fits of the whole model. Therefore, when two hypotheses are
// compared, 20 % of their difference is tolerated in addition to the noise. A hypothesis is ruled out if the
// most likely hypothesis explains the readings (chi-square test, 1 in 1000) and is at least 1000 times as
// likely as the hypothesis.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/gauge/gauge_file.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {

/// Returns the blocks of a model that define the static shape of the sensor, in the order of the signal path.
[[nodiscard]] std::vector<model::BlockSpec> static_sensor_blocks(const model::Model& model);

/// A hypothesis about the static shape of the sensor.
struct SensorShape {
  std::vector<model::BlockSpec> blocks;  ///< blocks from static_sensor_blocks(); empty: the sensor is linear
  double offset_mm = 0;                  ///< offset of the sensor zero that was fitted to the logs

  /// Returns the reading of the sensor at a displacement [mm].
  [[nodiscard]] double at(double displacement_mm) const;
  /// Returns the id of the shape: "straight", or the ids of its blocks, joined by "+".
  [[nodiscard]] std::string id() const;
};

/// Noise and range of the readings in the logs.
struct GaugeScales {
  double noise_mm = 0;    ///< standard deviation of the noise of one sample in the logs
  double lowest_mm = 0;   ///< lowest reading in the logs
  double highest_mm = 0;  ///< highest reading in the logs
};

/// Comparison of one hypothesis with the gauge readings.
struct GaugeFit {
  SensorShape shape;
  double zero_mm = 0;
  double scale = 1;
  std::size_t free = 2;
  /// Prediction for each reading, clipped at the same limits as the readings.
  std::vector<double> predicted_mm;
  double rms_mm = 0;  ///< RMS of the difference between reading and prediction, both clipped
  /// Error that is tolerated in addition to the noise when the hypothesis is compared with the most likely
  /// one.
  double tolerance_mm = 0;
  bool explains = false;  ///< true: the hypothesis explains the gauge readings
  bool ruled_out = false;
  /// Logarithm of a likelihood ratio: the likelihood of the most likely hypothesis divided by the likelihood
  /// of this hypothesis.
  double behind = 0;
};

enum class GaugeOutcome {
  /// At least one hypothesis is ruled out, or there is a single hypothesis and it explains the readings.
  decided,
  /// Several hypotheses explain the readings. The readings are too noisy, or they are not at the positions
  /// where the hypotheses differ.
  undecided,
  /// No hypothesis explains the readings. A hypothesis may still be ruled out if it is much less likely than
  /// another hypothesis.
  unexplained,
  /// The readings cover less than half of the range of the logs, so no hypothesis is tested.
  uncovered,
};
[[nodiscard]] const char* name_of(GaugeOutcome outcome);

struct GaugeCheck {
  GaugeOutcome outcome = GaugeOutcome::undecided;
  double lower_mm = 0;         ///< lower limit at which readings are clipped
  double upper_mm = 0;         ///< upper limit at which readings are clipped
  std::vector<double> cut_mm;  ///< gauge readings after they were clipped at these limits
  /// Part of the range of the logged readings that the gauge readings cover, from 0 to 1.
  double covered_share = 0;
  double repeat_noise_mm = 0;  ///< scatter of repeated readings at one position; 0: no position was repeated
  double noise_mm = 0;         ///< standard deviation of the noise that the test assumes for a reading
  std::vector<GaugeFit> fits;  ///< results of the hypotheses, in the order of the hypotheses
  std::size_t best = 0;        ///< index of the most likely hypothesis in `fits`
  /// Logarithm of the ratio of the likelihoods of the best and the second-best hypothesis; 0 if there is a
  /// single hypothesis.
  double log_likelihood_ratio = 0;
  /// Sensor shapes that are fitted to the gauge readings alone. They describe the nonlinearity of a sensor
  /// that no hypothesis explains.
  GaugeFit straight;
  GaugeFit free_bend;
  GaugeFit free_end;

  /// Deviation of the sensor from a straight line, and its significance. The deviation is that of the more
  /// likely one of free_bend and free_end.
  struct Departure {
    double rms_mm = 0;
    double largest_mm = 0;
    bool clear = false;
    bool clips = false;
  };
  [[nodiscard]] Departure departure() const;
};

/// Smallest difference of two log likelihoods that rules out the less likely hypothesis.
inline constexpr double gauge_log_likelihood_needed = limits::strict_log_likelihood;

/// Tests the hypotheses with gauge readings at three or more positions. There must be at least one
/// hypothesis, and the sensor shapes of the hypotheses must differ from each other.
[[nodiscard]] GaugeCheck check_gauge(const std::vector<GaugeReading>& readings,
                                     const std::vector<SensorShape>& hypotheses, const GaugeScales& scales);

}  // namespace softgrip::sysid
