#pragma once
// How well the twin is tracked, scheme by scheme: the paper's comparison, with mismatch, noise and margins.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "control/elements/feedforward.h"
#include "control/elements/pid.h"
#include "model/model.h"
#include "sysid/pages/page.h"

namespace softgrip::tools {

struct ControlStudyOptions {
  std::uint64_t seed = 1;
  int draws = 100;       ///< fingers per figure
  int search_draws = 3;  ///< others, on which gains are found
  std::vector<double> frequencies_hz{0.05, 0.1, 0.2, 0.5};
  std::vector<double> mismatches{0.05, 0.10};
  double most_sensitivity = 2;
  double rate_hz = 200;
  double noise_mm = 0.03;
  double mean_mm = 13;
  double amplitude_mm = 7;
  std::size_t starts = 12;  ///< of the identifications
  int iterations = 30;      ///< of the tuner's search
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;
};

/// A median and where 90 % of the draws lie.
struct Spread {
  double median = 0;
  double low = 0;   ///< 5 %
  double high = 0;  ///< 95 %
};

/// One scheme at one frequency and one mismatch.
struct ControlFigure {
  double frequency_hz = 0;
  double mismatch = 0;
  double amplitude_mm = 0;  ///< within reach of the twin at this frequency
  control::PidSettings pid;
  double sensitivity = 0;  ///< worst Ms over the tuner's fingers
  std::string limited_by;
  Spread rmse_mm;
  Spread most_mm;                ///< largest error
  double percent_of_stroke = 0;  ///< the median RMSE, of twice the amplitude
  double pressure_mean_kpa = 0;
  double pressure_most_kpa = 0;
  double out_of_reach_share = 0;
  std::vector<double> draws_mm;  ///< RMSE, draw by draw
};

/// One scheme.
struct ControlScheme {
  std::string id;
  std::string about;
  control::FeedforwardKind kind = control::FeedforwardKind::none;
  model::Model finger;    ///< the truth before it is drawn
  model::Model believed;  ///< by the controller
  std::string refusal;    ///< why there are no figures; empty: there are
  std::vector<ControlFigure> figures;
};

struct ControlStudy {
  ControlStudyOptions options;
  model::Model identified;  ///< published structure, from the twin's logs
  double identified_rmse_mm = 0;
  model::Model extended;  ///< with a valve
  double extended_rmse_mm = 0;
  std::vector<ControlScheme> schemes;
  double wall_s = 0;

  /// The figures of a scheme at a frequency and a mismatch; nullptr where there are none.
  [[nodiscard]] const ControlFigure* find(const std::string& id, double frequency_hz, double mismatch) const;
};

[[nodiscard]] ControlStudy study_control(const ControlStudyOptions& options);

/// control.json
[[nodiscard]] std::string control_json(const ControlStudy& study);
/// report.html
[[nodiscard]] sysid::Page control_page(const ControlStudy& study);
/// The tables for a terminal.
[[nodiscard]] std::string control_text(const ControlStudy& study);

}  // namespace softgrip::tools
