#pragma once
// Designs the next experiment: selects the waveform for which alternatives that explain the data equally well
// differ most. Before a comparison, each alternative is refitted to the prediction of the other one.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

struct ExperimentOptions {
  /// Limits of the rig. Default: the largest pressure of the logs and 300 kPa/s.
  std::optional<RigLimits> limits;
  /// True: if the verdict has no alternatives, design an experiment that compares it with the best rejected
  /// candidates.
  bool always = false;
  /// True: the rig can record the measured pressure, although the logs do not contain it (for the advice).
  bool pressure_recorded = false;
  double most_minutes = 10;
  /// Names of waveforms that were already played. They are not proposed again.
  std::vector<std::string> done;
  unsigned threads = 0;
};

/// Predicted distance between two structures, in one experiment.
struct Separation {
  std::string one;
  std::string other;
  /// Root of the sum of squared differences that remain after the refit, in standard deviations of the noise.
  /// The correlation of the noise is taken into account. The smaller value of two cases is used: `one` is
  /// true and `other` is refitted, or the reverse.
  double sigma = 0;
};

/// A waveform of the menu with its predicted separations.
struct JudgedWaveform {
  Waveform waveform;
  double minutes = 0;  ///< duration including the rest before the waveform
  std::vector<Separation> separations;
  double merit = 0;  ///< information per minute: sum of the squared separations, divided by `minutes`
};

/// A check of the sensor at known positions. It can separate alternatives with different sensor shapes that
/// no waveform separates.
struct ProposedGaugeCheck {
  std::vector<double> positions_mm;                       ///< positions in the order in which they are to be
                                                          ///< read
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of the positions
  std::vector<std::string> separates;                     ///< ids of causes
  double minutes = 0;
};

/// The proposed next experiment.
struct NextExperiment {
  std::optional<JudgedWaveform> best;
  std::vector<std::string> separates;             ///< ids that `best` separates
  double predicted_separation_sigma = 0;          ///< smallest separation among the pairs that `best`
                                                  ///< separates
  std::vector<JudgedWaveform> menu;               ///< all evaluated waveforms
  std::optional<ProposedGaugeCheck> gauge_check;  ///< empty if a gauge check separates no causes or was
                                                  ///< already made
  /// Advice on actions that no waveform can replace, such as to record a column or to change a load. Full
  /// sentences.
  std::vector<std::string> advice;
};

/// Name of the gauge file without readings that is written next to diagnosis.json if a gauge check is
/// proposed.
inline constexpr const char* gauge_positions_file = "gauge_positions.csv";

/// Smallest separation of two causes that counts as distinguishable.
inline constexpr double separation_needed_sigma = 5;

/// Designs the next experiment. Returns an empty design if the verdict requires no experiment.
[[nodiscard]] NextExperiment design_experiment(const Diagnosis& diagnosis, const ExperimentOptions& options);

/// Returns the proposed experiment as a sequence file for softgripd.
/// @param channel  channel to drive; empty: all channels of the rig.
[[nodiscard]] std::string sequence_yaml(const NextExperiment& experiment, const std::string& channel = "");
/// Returns the sequence file of a given waveform.
[[nodiscard]] std::string sequence_yaml(const Waveform& waveform, const std::string& channel);

/// Adds next_experiment, gauge_check and experiment_advice to the content of diagnosis.json. gauge_check is
/// null if none is proposed.
void add_experiment(nlohmann::ordered_json& diagnosis_json, const NextExperiment& experiment,
                    const std::string& file);

}  // namespace softgrip::sysid
