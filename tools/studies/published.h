#pragma once
// The study behind the project: what the published numbers of Zhang et al. 2025 say about a finger.
//
// 1. An ordinary actuator behind a valve that nobody modelled, identified with the published structure: how
//    far beta/(alpha + 1/k0) is from the truth.
// 2. The published response, matched by an ordinary, invertible actuator behind lag and delay.
// 3. What follows for an inverse of the Bouc-Wen element: the explicit form and the implicit one.
// 4. The paper's four RMSE figures, beside those of simulated fingers.

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"
#include "sysid/pages/page.h"
#include "tools/studies/paper_table.h"

namespace softgrip::tools {

struct PublishedOptions {
  std::uint64_t seed = 1;  ///< of noise and starts
  double rate_hz = 100;    ///< of all logs
  double noise_mm = 0.05;
  std::size_t starts = 12;     ///< of every identification and every match
  std::size_t most_cases = 9;  ///< of each table; fewer for a quick look
  unsigned threads = 0;        ///< 0: as many as there are cores
  std::function<void(const std::string&)> progress;
};

/// Row of the first table: a hidden valve and what the published structure makes of it.
struct HiddenLatency {
  double lag_s = 0;
  double delay_s = 0;
  double planned_ratio = 0;  ///< the figure that the study is to reproduce
  double ratio = 0;          ///< beta/(alpha + 1/k0) as fitted
  double true_ratio = 0;
  double other_ratio = 0;  ///< the same from the other triangles
  double rmse_mm = 0;
  double span_mm = 0;
  double tau2_s = 0;  ///< of the fitted faster branch
  double k2_kpa_per_mm = 0;
  double c2_kpa_s_per_mm = 0;
  bool refused = false;  ///< the controller would refuse the fitted model's inverse
  model::Model fitted;
};

/// Row of the second table.
struct PublishedMatch {
  double eta_per_bar = 0;  ///< assumed for the published model
  double rmse_mm = 0;
  double other_rmse_mm = 0;  ///< on a signal that was not used
  double span_mm = 0;
  double lag_s = 0;
  double delay_s = 0;
  double ratio = 0;  ///< beta/(alpha + 1/k0) of the match
  model::Model model;
};

/// Row of the third: the inverse of one Bouc-Wen element, asked for the pressure behind its own answer.
struct InverseTrial {
  double ratio = 0;   ///< beta/alpha
  double growth = 0;  ///< factor by which a small error of the explicit form grows, first sample to sample
  double explicit_error_kpa = 0;  ///< largest, of the explicit form, unbounded
  double implicit_error_kpa = 0;  ///< largest, of the implicit solve within 0 to 60 kPa
  double implicit_jump_kpa = 0;   ///< largest change from sample to sample
  double true_jump_kpa = 0;       ///< the same of the pressure that is to be found
  double unreached_share = 0;     ///< of the samples for which the implicit solve finds no pressure
  bool refused = false;           ///< by the check before a controller starts
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
  double twin_rmse_mm = 0;         ///< of bench_twin against the published response with eta 2 /bar
  double published_ratio = 0;      ///< beta/(alpha + 1/k0)
  double falls_until_kpa = 0;      ///< the published element falls on first loading up to here
  double falls_by_mm = 0;          ///< by so much
  double back_at_kpa = 0;          ///< and is back at 0 here; NaN: not below 60 kPa
  std::string bouc_wen_refusal;    ///< what the controller says of the published element
  std::string full_model_refusal;  ///< and of the whole published model
  sysid::Log match_log;            ///< of the first match: published response
  std::vector<double> match_mm;    ///< and the matching model's
  sysid::Log latency_log;          ///< of the longest latency: what was fitted
  std::vector<double> latency_mm;  ///< and what the fitted model says
  double wall_s = 0;
};

/// Two choices among triangles of 20 to 60 kPa at 0.1 to 0.4 Hz.
enum class Triangles {
  mixed,   ///< six, amplitude and rate independent, twice
  rising,  ///< three, the larger the faster, four times
};
/// The command; displacement_mm is empty.
[[nodiscard]] sysid::Log triangles(Triangles choice, double rate_hz);

[[nodiscard]] PublishedStudy study_published(const PublishedOptions& options);

/// A ratio for people: "> 100" where alpha + 1/k0 is next to nothing.
[[nodiscard]] std::string ratio_text(double ratio);
/// published.json
[[nodiscard]] std::string published_json(const PublishedStudy& study);
/// report.html
[[nodiscard]] sysid::Page published_page(const PublishedStudy& study);
/// The tables for a terminal.
[[nodiscard]] std::string published_text(const PublishedStudy& study);

}  // namespace softgrip::tools
