#pragma once
// Tests hypotheses about the static curve of a sensor (reading over displacement) against readings at known
// positions.
//
// Every hypothesis predicts reading = S(zero + scale * gauge) with unknown zero and scale. The function S
// consists of the static blocks of the sensor; if there are no such blocks, S is a straight line. Readings
// and predictions are clipped slightly outside the range of the readings in the logs. The logs do not show
// the behaviour of the sensor beyond this range.
//
// The noise is the larger of two values. The first value is the scatter of readings at one position. The
// second value is the noise of the logs divided by the square root of the number of samples per reading. The
// catalogue form only approximates the nonlinearity of the sensor, and its parameters come from fits of the
// whole model. Therefore, when two hypotheses are compared, 20 % of their difference is tolerated in addition
// to the noise. A hypothesis is ruled out under two conditions. The most likely hypothesis explains the
// readings (chi-square test, 1 in 1000), and it is at least 1000 times as likely as the hypothesis.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/gauge/gauge_file.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {

/// Returns the blocks of a model that define the static curve of the sensor (reading over displacement), in
/// the order of the signal path.
[[nodiscard]] std::vector<model::BlockSpec> static_sensor_blocks(const model::Model& model);

/// A hypothesis about the static curve of the sensor (reading over displacement), here called the sensor
/// shape.
struct SensorShape {
  std::vector<model::BlockSpec> blocks;  ///< blocks that define the shape (static_sensor_blocks()); empty:
                                         ///< the sensor is linear
  double offset_mm = 0;                  ///< zero offset of the sensor that was fitted to the logs

  /// Returns the reading of the sensor at a displacement [mm].
  [[nodiscard]] double at(double displacement_mm) const;
  /// Returns the id of the shape. It is "straight" for a linear sensor, otherwise the ids of the causes of
  /// its blocks, joined by "+".
  [[nodiscard]] std::string id() const;
};

/// Noise and range of the readings in the logs.
struct GaugeScales {
  double noise_mm = 0;    ///< standard deviation of the noise of one sample in the logs
  double lowest_mm = 0;   ///< lowest reading in the logs
  double highest_mm = 0;  ///< highest reading in the logs
};

/// Result of the comparison of one hypothesis with the gauge readings.
struct GaugeFit {
  SensorShape shape;
  double zero_mm = 0;
  double scale = 1;
  std::size_t free = 2;
  /// Predicted readings at the gauge positions, clipped at the same limits as the gauge readings.
  std::vector<double> predicted_mm;
  double rms_mm = 0;  ///< RMS difference between the gauge readings and the predictions; both are clipped
  /// Error that is tolerated in addition to the noise in the comparison with the most likely hypothesis.
  double tolerance_mm = 0;
  bool explains = false;  ///< true: the differences between the gauge readings and the predictions are within
                          ///< noise and tolerance
  bool ruled_out = false;
  /// Logarithm of the ratio (likelihood of the most likely hypothesis) / (likelihood of this hypothesis).
  double behind = 0;
};

enum class GaugeOutcome {
  /// At least one hypothesis is ruled out. With a single hypothesis: this hypothesis explains the readings.
  decided,
  /// Several hypotheses explain the readings. Either the readings are too noisy, or they were not taken at
  /// positions where the hypotheses differ.
  undecided,
  /// No hypothesis explains the readings. Nevertheless, a hypothesis can be ruled out if it differs much from
  /// the most likely one, because the tolerance increases with the difference.
  unexplained,
  /// The gauge readings cover less than half of the range of the readings in the logs, so no hypothesis is
  /// tested.
  uncovered,
};
[[nodiscard]] const char* name_of(GaugeOutcome outcome);

struct GaugeCheck {
  GaugeOutcome outcome = GaugeOutcome::undecided;
  double lower_mm = 0;         ///< lower clipping limit of the gauge readings and predictions
  double upper_mm = 0;         ///< upper clipping limit of the gauge readings and predictions
  std::vector<double> cut_mm;  ///< gauge readings, clipped at these limits
  /// Share of the range of the readings in the logs that the gauge readings cover, from 0 to 1.
  double covered_share = 0;
  double repeat_noise_mm = 0;  ///< scatter of the readings at the same position; 0: no position was repeated
  double noise_mm = 0;         ///< standard deviation of the noise that the test assumes for a reading
  std::vector<GaugeFit> fits;  ///< one result per hypothesis, in the order in which the hypotheses were
                               ///< passed
  std::size_t best = 0;        ///< index of the most likely hypothesis in `fits`
  /// Logarithm of the likelihood ratio of the best and the second-best hypothesis; 0 if there is only one
  /// hypothesis.
  double log_likelihood_ratio = 0;
  /// Sensor shapes that are fitted to the gauge readings alone. They describe a nonlinear sensor if no
  /// hypothesis explains the readings.
  GaugeFit straight;
  GaugeFit free_bend;
  GaugeFit free_end;

  /// Deviation of the sensor from a straight line. It is computed from the more likely shape of free_bend and
  /// free_end. `clear` states if the deviation is significant.
  struct Departure {
    double rms_mm = 0;
    double largest_mm = 0;
    bool clear = false;
    bool clips = false;
  };
  [[nodiscard]] Departure departure() const;
};

/// Smallest difference of two log likelihoods for which the less likely hypothesis is ruled out.
inline constexpr double gauge_log_likelihood_needed = limits::strict_log_likelihood;

/// Tests the hypotheses with gauge readings at three or more positions. At least one hypothesis is required,
/// and no two hypotheses may have the same sensor shape.
[[nodiscard]] GaugeCheck check_gauge(const std::vector<GaugeReading>& readings,
                                     const std::vector<SensorShape>& hypotheses, const GaugeScales& scales);

}  // namespace softgrip::sysid
