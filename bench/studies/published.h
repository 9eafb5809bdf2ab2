#pragma once
// Studies what the published parameters of Zhang et al. 2025 imply for a finger.
//
// 1. A model with the published structure, which has no valve, is identified from an ordinary actuator behind
//    a valve. The result is the deviation of beta/(alpha + 1/k0) from its true value.
// 2. An ordinary, invertible actuator behind lag and delay is fitted to the published response.
// 3. The explicit and the implicit inverse of the Bouc-Wen element are compared.
// 4. The four RMSE values of the paper are compared with the RMSE values of simulated fingers.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result/result.h"
#include "bench/studies/paper_table.h"
#include "model/model.h"
#include "sysid/logs/log.h"
#include "sysid/pages/page.h"

namespace softgrip::studies {

struct PublishedOptions {
  std::uint64_t seed = 1;  ///< seed of the noise and of the start points
  double rate_hz = 100;    ///< sampling rate of all logs
  double noise_mm = 0.05;
  std::size_t starts = 12;     ///< number of start points of every identification and every fit
  std::size_t most_cases = 9;  ///< largest number of rows in each table; fewer rows shorten the study
  unsigned threads = 0;        ///< number of threads; 0: one thread per processor core
  std::function<void(const std::string&)> progress;
};

/// Row of the first table: a model with the published structure was fitted to an actuator behind a valve. The
/// structure has no block for the valve.
struct HiddenLatency {
  double lag_s = 0;
  double delay_s = 0;
  double planned_ratio = 0;  ///< ratio beta/(alpha + 1/k0) that was expected when the study was planned
  double ratio = 0;          ///< ratio beta/(alpha + 1/k0) of the fitted model
  double true_ratio = 0;
  double other_ratio = 0;  ///< ratio beta/(alpha + 1/k0) of a second model, which was fitted to the triangles
                           ///< of the other kind
  double rmse_mm = 0;
  double span_mm = 0;
  double tau2_s = 0;  ///< time constant of the faster of the two fitted branches
  double k2_kpa_per_mm = 0;
  double c2_kpa_s_per_mm = 0;
  bool refused = false;  ///< true: the controller refuses to invert the fitted model
  model::Model fitted;
};

/// Row of the second table: an invertible model that was fitted to the published response.
struct PublishedMatch {
  double eta_per_bar = 0;  ///< value of eta that is assumed for the published model, because the paper does
                           ///< not state eta
  double rmse_mm = 0;
  double other_rmse_mm = 0;  ///< RMSE of the fitted model on a signal that was not fitted
  double span_mm = 0;
  double lag_s = 0;
  double delay_s = 0;
  double ratio = 0;  ///< ratio beta/(alpha + 1/k0) of the fitted model
  model::Model model;
};

/// Row of the third table: the inverses of one Bouc-Wen element, applied to the response of this element.
struct InverseTrial {
  double ratio = 0;               ///< ratio beta/alpha of the element
  double growth = 0;              ///< factor by which a small pressure error of the explicit inverse grows
                                  ///< per sample
  double explicit_error_kpa = 0;  ///< largest pressure error of the explicit inverse, which has no pressure
                                  ///< limits
  double implicit_error_kpa = 0;  ///< largest pressure error of the implicit inverse within the limits 0 to
                                  ///< 60 kPa
  double implicit_jump_kpa = 0;   ///< largest change per sample of the pressure that the implicit inverse
                                  ///< computes
  double true_jump_kpa = 0;       ///< largest change per sample of the true pressure
  double unreached_share = 0;     ///< share of the samples for which the implicit inverse has no solution
  bool refused = false;           ///< true: check_feedforward() refuses this element
  std::vector<double> explicit_kpa;
  std::vector<double> implicit_kpa;
};

struct PublishedStudy {
  PublishedOptions options;
  std::vector<HiddenLatency> latency;
  std::vector<PublishedMatch> matches;
  std::vector<InverseTrial> inverses;
  std::vector<PaperRow> paper;
  std::vector<double> inverse_time_s;
  std::vector<double> inverse_true_kpa;
  double twin_rmse_mm = 0;     ///< RMS difference between bench_twin and the published response for eta = 2
                               ///< /bar
  double published_ratio = 0;  ///< ratio beta/(alpha + 1/k0) of the published model
  double falls_until_kpa =
      0;  ///< on first loading, the response of the published element falls until this pressure is reached
  double falls_by_mm = 0;          ///< largest distance by which the response falls below 0
  double back_at_kpa = 0;          ///< pressure at which the response returns to 0; NaN: the response does
                                   ///< not return to 0 below 60 kPa
  std::string bouc_wen_refusal;    ///< reason why the controller refuses the published element
  std::string full_model_refusal;  ///< reason why the controller refuses the complete published model
  sysid::Log match_log;            ///< published response to which the model in the first row of `matches`
                                   ///< was fitted
  std::vector<double> match_mm;    ///< response of the model that was fitted to match_log [mm]
  sysid::Log latency_log;          ///< log to which the model in the row with the longest latency was fitted
  std::vector<double> latency_mm;  ///< response of the model that was fitted to latency_log [mm]
  double wall_s = 0;
};

/// Two sequences of triangles of 20 to 60 kPa at 0.1 to 0.4 Hz.
enum class Triangles {
  mixed,   ///< six triangles with independent amplitudes and rates; the sequence is played twice
  rising,  ///< three triangles whose rate increases with the amplitude; the sequence is played four times
};
/// Returns a log with the command of a sequence of triangles. The log contains no readings.
[[nodiscard]] sysid::Log triangles(Triangles choice, double rate_hz);

[[nodiscard]] PublishedStudy study_published(const PublishedOptions& options);

/// Formats a ratio beta/(alpha + 1/k0) as text. The text is "> 100" if alpha + 1/k0 is almost zero.
[[nodiscard]] std::string ratio_text(double ratio);
/// Returns the fields of a row of each table; the titled fields are the columns of the page.
[[nodiscard]] result::Fields fields_of(const HiddenLatency& row);
[[nodiscard]] result::Fields fields_of(const PublishedMatch& row);
[[nodiscard]] result::Fields fields_of(const InverseTrial& row);
[[nodiscard]] result::Fields fields_of(const PaperRow& row);

/// Returns the results of the study as the text of published.json.
[[nodiscard]] std::string published_json(const PublishedStudy& study);
/// Returns the results of the study as the page report.html.
[[nodiscard]] sysid::Page published_page(const PublishedStudy& study);
/// Returns the tables of the study as text for a terminal.
[[nodiscard]] std::string published_text(const PublishedStudy& study);

}  // namespace softgrip::studies
