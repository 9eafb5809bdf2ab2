#pragma once
// Designs the next experiment. Several causes may explain the logs equally well; the waveform that best
// separates these causes is selected. To compare two causes, the response with one cause is predicted, and
// the model with the other cause is refitted to this response.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

struct ExperimentOptions {
  /// Pressure limits of the rig. If not set, the limits are the largest pressure of the logs and 300 kPa/s.
  std::optional<RigLimits> limits;
  /// True: if the verdict lists no alternatives, the experiment compares the verdict with the best rejected
  /// candidates.
  bool always = false;
  /// True: the pressure is recorded. If false, the advice may propose to record the pressure.
  bool pressure_recorded = false;
  double most_minutes = 10;
  /// Names of waveforms that the rig has already executed. They are not proposed.
  std::vector<std::string> done;
  unsigned threads = 0;
};

/// Predicted distance between the responses of two structures in one experiment.
struct Separation {
  std::string one;
  std::string other;
  /// Distance of the two responses in standard deviations of the noise. The correlation of the noise is taken
  /// into account. The distance is computed twice: once, the structure `one` is true and `other` is refitted
  /// to its response; once, `other` is true and `one` is refitted. This member is the smaller distance.
  double sigma = 0;
};

/// A waveform that an experiment can apply, and the predicted separation of each pair of causes.
struct JudgedWaveform {
  Waveform waveform;
  double minutes = 0;  ///< duration of the waveform and of the rest before it
  std::vector<Separation> separations;
  double merit = 0;  ///< sum of the squared separations, divided by `minutes`
};

/// A proposed check of the sensor at known positions. It can separate causes that no waveform separates if
/// these causes imply different static shapes of the sensor.
struct ProposedGaugeCheck {
  /// Positions at which the sensor is to be read, in this order.
  std::vector<double> positions_mm;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of `positions_mm`
  std::vector<std::string> separates;                     ///< ids of the causes that the check separates
  double minutes = 0;
};

/// Proposal for the next experiment.
struct NextExperiment {
  std::optional<JudgedWaveform> best;
  std::vector<std::string> separates;  ///< ids of the causes that `best` separates
  /// Smallest separation of all pairs of causes that `best` separates.
  double predicted_separation_sigma = 0;
  std::vector<JudgedWaveform> menu;  ///< all waveforms that were evaluated
  /// Proposed gauge check; not set if a gauge check separates no causes or was already made.
  std::optional<ProposedGaugeCheck> gauge_check;
  /// Advice on actions that supplement the waveform, such as recording a further column or changing the load.
  /// Each element is one or more sentences.
  std::vector<std::string> advice;
};

/// Name of the gauge file without readings. It is written next to diagnosis.json if a gauge check is
/// proposed.
inline constexpr const char* gauge_positions_file = "gauge_positions.csv";

/// Smallest separation [standard deviations] at which two causes count as distinguishable.
inline constexpr double separation_needed_sigma = 5;

/// Designs the next experiment for a diagnosis. If the verdict requires no experiment, the result contains no
/// waveform.
[[nodiscard]] NextExperiment design_experiment(const Diagnosis& diagnosis, const ExperimentOptions& options);

/// Returns the proposed experiment as a sequence file for softgripd.
/// @param channel  channel that the sequence drives; empty: all channels of the rig.
[[nodiscard]] std::string sequence_yaml(const NextExperiment& experiment, const std::string& channel = "");
/// Returns the sequence file for one waveform.
[[nodiscard]] std::string sequence_yaml(const Waveform& waveform, const std::string& channel);

/// Adds the keys next_experiment, gauge_check and experiment_advice to the content of diagnosis.json.
/// gauge_check is null if no gauge check is proposed.
void add_experiment(nlohmann::ordered_json& diagnosis_json, const NextExperiment& experiment,
                    const std::string& file);

}  // namespace softgrip::sysid
