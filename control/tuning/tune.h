#pragma once
// PID gains for a finger that is not quite what its model says.

#include <cstdint>
#include <string>
#include <vector>

#include "control/feedforward/pressure_plan.h"
#include "control/tick/channel_settings.h"
#include "control/tuning/tracking_run.h"
#include "model/model.h"

namespace softgrip::control {

/// The task of a tuning. The finger is drawn around `finger`, the controller believes `channel.model`.
struct TuneTask {
  ChannelSettings channel;  ///< model, feedforward and limits; the gains in it are not used
  model::Model finger;
  double rate_hz = 200;
  double exchange_s = 0;  ///< from the tick to the board, as in TrackingRun
  double mean_mm = 13;
  double amplitude_mm = 7;
  std::vector<double> frequencies_hz{0.1, 0.3};  ///< of the sines that are tracked
  double noise_mm = 0.03;
  double mismatch = 0.05;       ///< every parameter of the finger off by up to this share
  int draws = 6;                ///< fingers
  double most_sensitivity = 2;  ///< Ms of every one of them: gain margin 2, phase margin 29 degrees
  std::uint64_t seed = 1;
  int iterations = 40;  ///< of the search, after its grid
};

/// The optimum, its margin and its errors.
struct Tuned {
  PidSettings pid;
  double sensitivity = 0;   ///< the worst Ms over the fingers
  double crossover_hz = 0;  ///< the lowest over the fingers
  double rmse_mm = 0;       ///< root mean square over fingers and frequencies
  double exact_mm = 0;      ///< the same with the finger as it was given and without noise
  double noisy_mm = 0;      ///< the finger as given, with noise
  double mismatch_mm = 0;   ///< fingers drawn, without noise
  int evaluations = 0;
  std::string limited_by;  ///< in words
};

/// Minimises the tracking error over the fingers under the bound on Ms: a grid over kp and ki, then Nelder
/// and Mead's search (Computer Journal 7, 1965) over kp, ki and the derivative time. The derivative's filter
/// is an eighth of its time, at least two ticks.
[[nodiscard]] Tuned tune(const TuneTask& task);

/// A sine that the model reaches: mean and amplitude as shares of what it shows at the highest pressure.
void choose_reference(TuneTask& task);

}  // namespace softgrip::control
