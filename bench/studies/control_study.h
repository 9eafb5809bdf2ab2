#pragma once
// Compares the tracking errors of several control schemes on the simulated finger bench_twin, as Zhang et al.
// 2025 do. The study also covers model errors, noise and stability margins, which the paper does not cover.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "control/elements/feedforward.h"
#include "control/elements/pid.h"
#include "model/model.h"
#include "sysid/pages/page.h"

namespace softgrip::studies {

struct ControlStudyOptions {
  std::uint64_t seed = 1;
  int draws = 100;       ///< number of simulated fingers with random parameters per scheme, frequency and
                         ///< mismatch
  int search_draws = 3;  ///< number of additional simulated fingers for the search of the gains
  std::vector<double> frequencies_hz{0.05, 0.1, 0.2, 0.5};
  std::vector<double> mismatches{0.05, 0.10};
  double most_sensitivity = 2;
  double rate_hz = 200;
  double noise_mm = 0.03;
  double mean_mm = 13;
  double amplitude_mm = 7;
  std::size_t starts = 12;  ///< number of start points of each identification
  int iterations = 30;      ///< number of iterations of the gain search
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;
};

/// Median of a result over the simulated fingers, with the range that contains 90 % of the fingers.
struct Spread {
  double median = 0;
  double low = 0;   ///< 5 % quantile over the simulated fingers
  double high = 0;  ///< 95 % quantile over the simulated fingers
};

/// The result of one control scheme at one frequency and one model mismatch.
struct ControlFigure {
  double frequency_hz = 0;
  double mismatch = 0;
  double amplitude_mm = 0;  ///< amplitude of the reference: the largest amplitude that bench_twin can track
                            ///< at this frequency, but not more than the amplitude of the study
  control::PidSettings pid;
  double sensitivity = 0;  ///< largest sensitivity Ms = max |1/(1+L)| of the control loop. The largest value
                           ///< is taken over the simulated fingers that the gain search used
  std::string limited_by;
  Spread rmse_mm;
  Spread most_mm;                ///< largest absolute error of each simulated finger
  double percent_of_stroke = 0;  ///< median RMSE in percent of the stroke, which is twice the amplitude
  double pressure_mean_kpa = 0;
  double pressure_most_kpa = 0;
  double out_of_reach_share = 0;
  std::vector<double> draws_mm;  ///< RMSE of each simulated finger [mm]
};

/// A control scheme, with its results in the study.
struct ControlScheme {
  std::string id;
  std::string about;
  control::FeedforwardKind kind = control::FeedforwardKind::none;
  model::Model finger;    ///< simulated finger before its parameters are varied at random
  model::Model believed;  ///< the model that the controller uses
  std::string refusal;    ///< reason why the scheme has no results; empty if the scheme has results
  std::vector<ControlFigure> figures;
};

struct ControlStudy {
  ControlStudyOptions options;
  model::Model identified;  ///< model with the published structure, identified from logs of bench_twin
  double identified_rmse_mm = 0;
  /// Model with the published structure and additional blocks for the valve. The model was identified from
  /// the same logs as `identified`.
  model::Model extended;
  double extended_rmse_mm = 0;
  std::vector<ControlScheme> schemes;
  double wall_s = 0;

  /// Returns the result of a scheme at a frequency and a mismatch; nullptr if the study has no such result.
  [[nodiscard]] const ControlFigure* find(const std::string& id, double frequency_hz, double mismatch) const;
};

[[nodiscard]] ControlStudy study_control(const ControlStudyOptions& options);

/// Returns the results of the study as the text of control.json.
[[nodiscard]] std::string control_json(const ControlStudy& study);
/// Returns the results of the study as the page report.html.
[[nodiscard]] sysid::Page control_page(const ControlStudy& study);
/// Returns the tables of the study as text for a terminal.
[[nodiscard]] std::string control_text(const ControlStudy& study);

}  // namespace softgrip::studies
