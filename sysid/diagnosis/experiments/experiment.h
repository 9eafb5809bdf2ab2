#pragma once
// Designs the next experiment if several causes explain the logs equally well. The result is the waveform
// that best separates these causes. To compare two causes, the program predicts the response with one cause
// and refits the model with the other cause to this response.

#include <optional>
#include <string>
#include <vector>

#include "base/result/result.h"
#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

struct ExperimentOptions {
  /// Pressure limits of the rig. Not set: the largest pressure of the logs, and a slew rate of 300 kPa/s.
  std::optional<RigLimits> limits;
  /// True: an experiment is designed even if the verdict lists no alternatives. It then compares the named
  /// cause with at most two other candidates. If no cause is named, it compares the refitted model with at
  /// most two rejected causes.
  bool always = false;
  /// True: the logs contain the measured pressure. False: the advice may be to record the pressure.
  bool pressure_recorded = false;
  double most_minutes = 10;
  /// Names of the waveforms that the rig has already executed. They are not proposed a second time.
  std::vector<std::string> done;
  unsigned threads = 0;
};

/// Predicted distance between the responses of two hypotheses in one experiment.
struct Separation {
  std::string one;
  std::string other;
  /// Distance of the two responses in standard deviations of the noise; the correlation of the noise is
  /// included. The distance is computed twice. First, `other` is refitted to the response of `one`. Second,
  /// `one` is refitted to the response of `other`. This member is the smaller one of both distances.
  double sigma = 0;
};

/// A possible waveform for the experiment, and the predicted separation of each pair of causes by this
/// waveform.
struct JudgedWaveform {
  Waveform waveform;
  double minutes = 0;  ///< duration of the waveform plus the rest before the waveform
  std::vector<Separation> separations;
  double merit = 0;  ///< sum of the squared separations, divided by `minutes`; a separation below 5 counts as
                     ///< 0, one above 40 as 40
};

/// A proposed check of the sensor at known positions. It separates causes that imply different static curves
/// of the sensor (reading over displacement), even if no waveform separates them.
struct ProposedGaugeCheck {
  /// Positions in the order in which the operator reads the sensor.
  std::vector<double> positions_mm;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of `positions_mm`
  std::vector<std::string> separates;                     ///< ids of the causes that the check separates
  double minutes = 0;
};

/// Proposal for the next experiment: a waveform, a gauge check or advice.
struct NextExperiment {
  std::optional<JudgedWaveform> best;
  std::vector<std::string> separates;  ///< ids of the causes that `best` separates
  /// Smallest separation among the pairs of causes that `best` separates [standard deviations].
  double predicted_separation_sigma = 0;
  std::vector<JudgedWaveform> menu;  ///< all waveforms that were evaluated
  /// Proposed gauge check. Not set: a gauge check would separate no causes, or the operator has already made
  /// one.
  std::optional<ProposedGaugeCheck> gauge_check;
  /// Advice on further actions, such as recording one more column or changing the load. Each element consists
  /// of one or more sentences.
  std::vector<std::string> advice;
};

/// Name of the sequence file of the proposed experiment, in the folder of diagnosis.json.
inline constexpr const char* experiment_file = "next_experiment.yaml";
/// Name of the gauge file with empty readings. If a gauge check is proposed, the file is written to the
/// folder of diagnosis.json.
inline constexpr const char* gauge_positions_file = "gauge_positions.csv";

/// Smallest separation for which two causes count as distinguishable [standard deviations].
inline constexpr double separation_needed_sigma = 5;

/// Designs the next experiment for a diagnosis. The result is empty if the verdict is not ambiguous and
/// `always` is false. The result contains no waveform if no waveform separates two of the causes.
[[nodiscard]] NextExperiment design_experiment(const Diagnosis& diagnosis, const ExperimentOptions& options);

/// Returns the proposed experiment as the text of a sequence file for softgripd.
/// @param channel  channel on which the sequence runs; empty: all channels of the rig.
[[nodiscard]] std::string sequence_yaml(const NextExperiment& experiment, const std::string& channel = "");
/// Returns the text of the sequence file for one waveform.
[[nodiscard]] std::string sequence_yaml(const Waveform& waveform, const std::string& channel);

/// Returns the fields next_experiment, gauge_check, experiments_judged and experiment_advice of
/// diagnosis.json. next_experiment or gauge_check is null if the proposal does not contain it.
[[nodiscard]] result::Fields fields_of(const NextExperiment& experiment);

}  // namespace softgrip::sysid
