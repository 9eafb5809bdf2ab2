#pragma once
// Tunes PID gains for fingers whose parameters differ from those of the model in the controller.

#include <cstdint>
#include <string>
#include <vector>

#include "control/feedforward/pressure_plan.h"
#include "control/tick/settings.h"
#include "control/tuning/tracking_run.h"
#include "model/model.h"

namespace softgrip::control {

/// The input of a tuning. The simulated fingers are random variations of `finger`; the controller uses
/// `channel.model`.
struct TuneTask {
  ChannelSettings channel;  ///< model, feedforward and limits of the controller; its PID gains are not used
  model::Model finger;
  double rate_hz = 200;
  double exchange_s = 0;  ///< time from the start of a tick to its exchange, as in TrackingRun
  double mean_mm = 13;
  double amplitude_mm = 7;
  std::vector<double> frequencies_hz{0.1, 0.3};  ///< frequencies of the tracked sines
  double noise_mm = 0.03;
  double mismatch = 0.05;       ///< largest relative difference of a finger's parameter from the parameter of
                                ///< `finger`
  int draws = 6;                ///< number of random fingers
  double most_sensitivity = 2;  ///< largest permitted Ms of each finger; Ms = 2 means a gain margin of at
                                ///< least 2 and a phase margin of at least 29 degrees
  std::uint64_t seed = 1;
  int iterations = 40;  ///< number of iterations of the simplex search after the grid search
};

/// The best gains, their stability margin and their tracking errors.
struct Tuned {
  PidSettings pid;
  double sensitivity = 0;   ///< worst sensitivity Ms over the fingers
  double crossover_hz = 0;  ///< lowest crossover frequency over the fingers
  double rmse_mm = 0;       ///< root mean square tracking error over fingers and frequencies
  double exact_mm = 0;      ///< tracking error for the unchanged `finger`, without noise
  double noisy_mm = 0;      ///< tracking error for the unchanged `finger`, with noise
  double mismatch_mm = 0;   ///< tracking error for the random fingers, without noise
  int evaluations = 0;
  std::string limited_by;  ///< factor that prevents a smaller tracking error, as text
};

/// Returns the gains with the smallest tracking error over all fingers. The largest sensitivity Ms must not
/// exceed most_sensitivity. A grid search in kp and ki comes first; the simplex search of Nelder and Mead
/// (Computer Journal 7, 1965) refines the result. The simplex search varies kp, ki and the derivative time.
/// The filter time of the derivative is 1/8 of the derivative time, but at least two ticks.
[[nodiscard]] Tuned tune(const TuneTask& task);

/// Sets the sine of the task to a sine that the model can follow. The mean and the amplitude are fixed shares
/// of the motion between the rest pressure and the end of the pressure range that is further from the rest
/// pressure.
void choose_reference(TuneTask& task);

}  // namespace softgrip::control
