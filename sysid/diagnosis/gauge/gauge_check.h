#pragma once
// What a gauge says about a sensor: hypotheses about its static shape against readings at known positions.
//
// Every hypothesis predicts reading = S(zero + scale * gauge) with a zero and a scale of its own, which
// nobody knows, and S the sensor's static blocks (none: a straight line). Readings and predictions are cut
// at the ends of what the logs have read, a little beyond: what the sensor does further out no log has seen.
//
// The noise is the larger of what readings at one position differ by and the logs' noise, over the root of
// the samples in a reading. The catalogue's form of a bend is not the sensor's, and its numbers come from
// fits that shared them with the rest of the model; so a fifth of what two hypotheses differ by is allowed
// beside the noise where they are compared. A hypothesis is ruled out where the most likely one explains the
// readings (chi-square, 1 in 1000) and is at least a thousand times as likely.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/gauge/gauge_file.h"

namespace softgrip::sysid {

/// The blocks of a model that make a sensor of another static shape, in chain order.
[[nodiscard]] std::vector<model::BlockSpec> static_sensor_blocks(const model::Model& model);

/// What the sensor might be.
struct SensorShape {
  std::vector<model::BlockSpec> blocks;  ///< static_sensor_blocks(); none: straight
  double offset_mm = 0;                  ///< of its zero, as fitted to the logs

  /// What it shows at a displacement [mm].
  [[nodiscard]] double at(double displacement_mm) const;
  /// "straight", or the ids of its blocks joined by "+".
  [[nodiscard]] std::string id() const;
};

/// What the logs know of the sensor.
struct GaugeScales {
  double noise_mm = 0;  ///< of one sample in the logs
  double lowest_mm = 0;
  double highest_mm = 0;  ///< readings of the logs
};

/// One hypothesis against the readings.
struct GaugeFit {
  SensorShape shape;
  double zero_mm = 0;
  double scale = 1;
  std::size_t free = 2;
  std::vector<double> predicted_mm;  ///< per reading, cut as the readings are
  double rms_mm = 0;                 ///< of reading minus prediction, both cut
  double tolerance_mm = 0;  ///< allowed beside the noise where it is compared with the most likely one
  bool explains = false;    ///< the readings
  bool ruled_out = false;
  double behind = 0;  ///< log likelihood ratio of the most likely hypothesis over this one
};

enum class GaugeOutcome {
  decided,      ///< at least one hypothesis is ruled out, or there is only one and it fits
  undecided,    ///< the readings fit more than one: too noisy, or not where the hypotheses differ
  unexplained,  ///< they fit none; what is much further off than another one may be ruled out all the same
  uncovered,    ///< they cover less than half of what the logs have read: nothing is judged
};
[[nodiscard]] const char* name_of(GaugeOutcome outcome);

struct GaugeCheck {
  GaugeOutcome outcome = GaugeOutcome::undecided;
  double lower_mm = 0;  ///< where readings are cut
  double upper_mm = 0;
  std::vector<double> cut_mm;  ///< the readings, cut
  double covered_share = 0;    ///< of the logs' readings
  double repeat_noise_mm = 0;  ///< 0: no position came twice
  double noise_mm = 0;         ///< that was used
  std::vector<GaugeFit> fits;  ///< in the order of the hypotheses
  std::size_t best = 0;        ///< the most likely one
  /// Of the best over the next; 0 with a single hypothesis.
  double log_likelihood_ratio = 0;
  /// The shapes refitted to the readings alone: how a sensor that fits none is bent.
  GaugeFit straight;
  GaugeFit free_bend;
  GaugeFit free_end;

  /// How far the more likely of free_bend and free_end is from a straight line [mm, rms and largest] and
  /// whether that is beyond doubt.
  struct Departure {
    double rms_mm = 0;
    double largest_mm = 0;
    bool clear = false;
    bool clips = false;
  };
  [[nodiscard]] Departure departure() const;
};

inline constexpr double gauge_log_likelihood_needed = 6.9;  ///< ln 1000

/// At least three positions; at least one hypothesis, no two of the same shape.
[[nodiscard]] GaugeCheck check_gauge(const std::vector<GaugeReading>& readings,
                                     const std::vector<SensorShape>& hypotheses, const GaugeScales& scales);

}  // namespace softgrip::sysid
