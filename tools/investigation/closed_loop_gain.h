#pragma once
// Computes the benefit of an extended model in closed loop. Simulated rigs track the same reference three
// times: with the refitted model in the feedforward, with the extended model in the feedforward, and with the
// PID controller alone. The PID gains of all three cases are tuned by the same search method.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result/result.h"
#include "control/elements/feedforward.h"
#include "control/elements/pid.h"
#include "control/feedforward/invertibility.h"
#include "control/tuning/tracking_run.h"
#include "model/model.h"

namespace softgrip::tools {

/// The models, logs and settings that the comparison needs.
struct ClosedLoopQuestion {
  model::Model recalibrated;
  model::Model extended;  ///< the extended model; the simulated rigs are this model with parameters changed
                          ///< by up to `rig_scatter`
  double noise_mm = 0.03;
  double span_mm = 0;  ///< displacement span of the logs [mm]; 0: unknown. If the reference of 13 ± 7 mm
                       ///< exceeds the span, the reference is scaled down.
  double pressure_max_kpa = 60;
  double frequency_hz = 0.2;
  double rig_scatter = 0.02;  ///< largest relative difference between a parameter of the simulated rig and
                              ///< the same parameter of the extended model
  std::uint64_t seed = 1;
};

/// The tracking result of one controller on the simulated rigs.
struct ClosedLoopScheme {
  double rmse_mm = 0;  ///< median over the simulated rigs of the RMSE of tracking [mm]
  control::PidSettings pid;
  /// Kind of the feedforward. If the model has a causal inverse, the value is full_model. If it has none, the
  /// value is the best of three: planned, full_model of the invertible part, and none (the PID alone). If the
  /// value is none, all results are the results of the PID alone.
  control::FeedforwardKind feedforward = control::FeedforwardKind::none;
  std::string refused;  ///< reason why the complete model is not used as full_model; empty: the complete
                        ///< model is used
  std::optional<control::InvertiblePart> part;  ///< the part of the model that is inverted; nullopt: the
                                                ///< complete model is inverted
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

/// Returns the value of the key "closed_loop" of diagnosis.json and investigation.json.
[[nodiscard]] result::Fields fields_of(const ClosedLoopGain& gain);

}  // namespace softgrip::tools
