#pragma once
// Computes the benefit of an extended model in closed loop. Simulated rigs track the same reference twice:
// with the refitted and with the extended model in the feedforward. One search method tunes the PID gains for
// both.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/elements/feedforward.h"
#include "control/elements/pid.h"
#include "control/feedforward/invertible_part.h"
#include "control/tuning/tracking_run.h"
#include "model/model.h"

namespace softgrip::tools {

/// The models, logs and settings that the comparison needs.
struct ClosedLoopQuestion {
  model::Model recalibrated;
  model::Model extended;  ///< the extended model; with parameters changed by up to `rig_scatter`, it is also
                          ///< the simulated rig
  double noise_mm = 0.03;
  double span_mm = 0;  ///< displacement span of the logs [mm]; the reference of 13 ± 7 mm is scaled down if
                       ///< it exceeds the span; 0: unknown
  double pressure_max_kpa = 60;
  double frequency_hz = 0.2;
  double rig_scatter = 0.02;  ///< largest relative difference between a parameter of the simulated rig and
                              ///< that of the extended model
  std::uint64_t seed = 1;
};

/// The tracking result of one controller on the simulated rigs.
struct ClosedLoopScheme {
  double rmse_mm = 0;  ///< median of the RMSE over the simulated rigs
  control::PidSettings pid;
  /// Kind of the feedforward. It is full_model if the model has a causal inverse. Otherwise it is the better
  /// of planned and full_model of the invertible part. If the PID alone is at least as good as both, the
  /// value is none, and all results are the results of the PID alone.
  control::FeedforwardKind feedforward = control::FeedforwardKind::none;
  std::string refused;  ///< reason why the whole model is not used as full_model; empty: it is used
  std::optional<control::InvertiblePart> part;  ///< the part of the model that is inverted; nullopt: the
                                                ///< whole model
  control::TrackingTrace trace;                 ///< trace of the simulated rig that has the median error
};

struct ClosedLoopGain {
  ClosedLoopScheme pid_alone;
  ClosedLoopScheme recalibrated;
  ClosedLoopScheme extended;
  double mean_mm = 13;
  double amplitude_mm = 7;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  double frequency_hz = 0.2;
  double rig_scatter = 0;
  int rigs = 0;
  double wall_s = 0;

  [[nodiscard]] std::string reference() const;  ///< Returns the reference as text, for example "13 ±
                                                ///< 7 mm at 0.2 Hz".
  [[nodiscard]] std::vector<std::string> notes() const;  ///< Returns remarks on the conditions of the
                                                         ///< comparison.
};

[[nodiscard]] ClosedLoopGain measure_closed_loop(const ClosedLoopQuestion& question);

/// Adds the member "closed_loop" to the JSON of diagnosis.json or investigation.json.
void add_closed_loop(nlohmann::ordered_json& json, const ClosedLoopGain& gain);

}  // namespace softgrip::tools
