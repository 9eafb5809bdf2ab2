// Formats the study of the published model as text for a terminal and as JSON.

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "bench/studies/models.h"
#include "bench/studies/published.h"
#include "bench/studies/study_text.h"
#include "sysid/pages/page.h"

namespace softgrip::studies {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string paper_text(const std::vector<PaperRow>& rows) {
  std::string text =
      "4. RMSE [mm] of the published structure, identified on tp1 (% of span)\n"
      "   signal   the paper's finger   the published model   bench_twin: latency behind it\n";
  for (const PaperRow& row : rows) {
    const auto figure = [](const PaperFigure& f) {
      return fixed(f.rmse_mm, 4) + " (" + fixed(f.rmse_percent_of_span, 2) + ")";
    };
    text += "   " + cell(std::string(model::name_of(row.signal)), 6) + cell(fixed(row.paper_mm, 3), 21) +
            cell(figure(row.published), 22) + cell(figure(row.twin), 32) + "\n";
  }
  return text;
}

}  // namespace

std::string ratio_text(double ratio) {
  return ratio > 100 ? "> 100" : significant(ratio, 3);
}

std::string published_text(const PublishedStudy& study) {
  std::string text = "1. An ordinary actuator (beta/(alpha + 1/k0) = " +
                     fixed(study.latency.empty() ? 0 : study.latency.front().true_ratio, 2) +
                     ") behind a hidden valve, identified with the published structure\n"
                     "   lag/delay [s]   beta/(alpha+1/k0)   other triangles   planned   RMSE [mm]   span "
                     "[mm]   tau2 [s]   k2, "
                     "c2 [bar]     inverse\n";
  for (const HiddenLatency& row : study.latency) {
    text += "   " + cell(fixed(row.lag_s, 2) + " / " + fixed(row.delay_s, 2), 13) +
            cell(significant(row.ratio, 3), 20) + cell(ratio_text(row.other_ratio), 18) +
            cell(significant(row.planned_ratio, 3), 10) + cell(fixed(row.rmse_mm, 3), 12) +
            cell(fixed(row.span_mm, 1), 12) + cell(fixed(row.tau2_s, 3), 11) +
            cell(significant(row.k2_kpa_per_mm / kpa_per_bar, 3) + ", " +
                     significant(row.c2_kpa_s_per_mm / kpa_per_bar, 3),
                 18) +
            (row.refused ? "   refused" : "   exists") + "\n";
  }
  text +=
      "2. The published response (tp1), matched by an invertible actuator (beta <= 0.8 (alpha + 1/k0)) "
      "behind "
      "lag and delay\n"
      "   eta [1/bar]   RMSE [mm]   on tp2 [mm]   span [mm]   lag [s]   delay [s]   lag + delay [s]   "
      "beta/(alpha+1/k0)\n";
  for (const PublishedMatch& row : study.matches) {
    text += "   " + cell(significant(row.eta_per_bar), 11) + cell(fixed(row.rmse_mm, 4), 12) +
            cell(fixed(row.other_rmse_mm, 4), 14) + cell(fixed(row.span_mm, 1), 12) +
            cell(fixed(row.lag_s, 3), 10) + cell(fixed(row.delay_s, 3), 12) +
            cell(fixed(row.lag_s + row.delay_s, 3), 18) + cell(fixed(row.ratio, 3), 20) + "\n";
  }
  text += "   model bench_twin, compared with the published response for eta = 2 /bar: RMSE " +
          fixed(study.twin_rmse_mm, 4) + " mm\n";
  text +=
      "3. The inverse of the published Bouc-Wen element with other betas, for a sine of 0 to 60 kPa at 0.1 "
      "Hz\n"
      "   beta/alpha   explicit: growth/sample   error [kPa]   implicit: error [kPa]   jump [kPa] (true)   "
      "not reached   inverse\n";
  for (const InverseTrial& row : study.inverses) {
    text += "   " + cell(significant(row.ratio, 3), 10) + cell(significant(row.growth, 3), 26) +
            cell(significant(row.explicit_error_kpa, 2), 14) +
            cell(significant(row.implicit_error_kpa, 2), 24) +
            cell(significant(row.implicit_jump_kpa, 3) + " (" + significant(row.true_jump_kpa, 2) + ")", 20) +
            cell(fixed(100 * row.unreached_share, 0) + " %", 14) +
            (row.refused ? "   refused" : "   exists") + "\n";
  }
  text +=
      "   The published element falls by " + fixed(study.falls_by_mm, 2) + " mm until " +
      fixed(study.falls_until_kpa, 1) + " kPa" +
      (std::isfinite(study.back_at_kpa) ? " and returns to 0 mm at " + fixed(study.back_at_kpa, 1) + " kPa"
                                        : " and does not return to 0 mm below 60 kPa") +
      ".\n   bouc_wen:   " + study.bouc_wen_refusal + "\n   full_model: " + study.full_model_refusal + "\n";
  text += paper_text(study.paper);
  return text + "seed " + std::to_string(study.options.seed) + ", " + significant(study.wall_s, 3) + " s\n";
}

std::string published_json(const PublishedStudy& study) {
  Json json;
  json["schema"] = 1;
  json["software"] = sysid::software_and_version();
  json["seed"] = study.options.seed;
  json["rate_hz"] = study.options.rate_hz;
  json["noise_mm"] = study.options.noise_mm;
  json["starts"] = study.options.starts;
  json["hidden_latency"] = Json::array();
  for (const HiddenLatency& row : study.latency) {
    json["hidden_latency"].push_back({{"lag_s", row.lag_s},
                                      {"delay_s", row.delay_s},
                                      {"ratio", row.ratio},
                                      {"ratio_other_triangles", row.other_ratio},
                                      {"ratio_planned", row.planned_ratio},
                                      {"ratio_true", row.true_ratio},
                                      {"rmse_mm", row.rmse_mm},
                                      {"span_mm", row.span_mm},
                                      {"tau2_s", row.tau2_s},
                                      {"k2_kpa_per_mm", row.k2_kpa_per_mm},
                                      {"c2_kpa_s_per_mm", row.c2_kpa_s_per_mm},
                                      {"inverse_refused", row.refused},
                                      {"parameters", parameters_of(row.fitted)}});
  }
  json["published_response"] = Json::array();
  for (const PublishedMatch& row : study.matches) {
    json["published_response"].push_back({{"eta_per_bar", row.eta_per_bar},
                                          {"rmse_mm", row.rmse_mm},
                                          {"rmse_unseen_mm", row.other_rmse_mm},
                                          {"span_mm", row.span_mm},
                                          {"lag_s", row.lag_s},
                                          {"delay_s", row.delay_s},
                                          {"ratio", row.ratio},
                                          {"parameters", parameters_of(row.model)}});
  }
  json["inverse"] = Json::array();
  for (const InverseTrial& row : study.inverses) {
    json["inverse"].push_back({{"beta_over_alpha", row.ratio},
                               {"explicit_growth_per_sample", row.growth},
                               {"explicit_error_kpa", number(row.explicit_error_kpa)},
                               {"implicit_error_kpa", number(row.implicit_error_kpa)},
                               {"implicit_jump_kpa", row.implicit_jump_kpa},
                               {"true_jump_kpa", row.true_jump_kpa},
                               {"unreached_share", row.unreached_share},
                               {"refused", row.refused}});
  }
  json["paper_rmse"] = Json::array();
  for (const PaperRow& row : study.paper) {
    json["paper_rmse"].push_back({{"signal", model::name_of(row.signal)},
                                  {"paper_mm", row.paper_mm},
                                  {"published_mm", row.published.rmse_mm},
                                  {"published_percent_of_span", row.published.rmse_percent_of_span},
                                  {"bench_twin_mm", row.twin.rmse_mm},
                                  {"bench_twin_percent_of_span", row.twin.rmse_percent_of_span}});
  }
  json["published"] = {{"ratio", study.published_ratio},
                       {"bench_twin_rmse_mm", study.twin_rmse_mm},
                       {"falls_by_mm", study.falls_by_mm},
                       {"falls_until_kpa", study.falls_until_kpa},
                       {"back_at_kpa", number(study.back_at_kpa)},
                       {"bouc_wen_refusal", study.bouc_wen_refusal},
                       {"full_model_refusal", study.full_model_refusal}};
  json["wall_s"] = study.wall_s;
  return json.dump(2) + "\n";
}

}  // namespace softgrip::studies
