// Formats the study of the published model as text for a terminal and as JSON.

#include <cmath>

#include "base/numbers.h"
#include "bench/studies/models.h"
#include "bench/studies/published.h"
#include "bench/studies/study_text.h"
#include "sysid/pages/page.h"

namespace softgrip::studies {
namespace {

using result::decimals, result::Fields, result::list_of, result::number, result::shown;

/// Returns a value per kPa, which the page shows per bar.
result::Value in_bar(double per_kpa) {
  return shown(per_kpa, significant(per_kpa / kpa_per_bar, 3), true);
}

std::string paper_text(const std::vector<PaperRow>& rows) {
  std::string text =
      "4. RMSE [mm] of the published structure, identified on tp1 (% of span)\n"
      "   signal   the paper's finger   the published model      bench_twin (with latency)\n";
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

Fields fields_of(const HiddenLatency& row) {
  return {
      {"lag_s", "lag / delay [s]",
       shown(row.lag_s, fixed(row.lag_s, 2) + " / " + fixed(row.delay_s, 2), true)},
      {"delay_s", row.delay_s},
      {"ratio", "ratio", number(row.ratio, 3)},
      {"ratio_other_triangles", "other triangles", shown(row.other_ratio, ratio_text(row.other_ratio), true)},
      {"ratio_planned", row.planned_ratio},
      {"ratio_true", row.true_ratio},
      {"rmse_mm", "RMSE [mm]", decimals(row.rmse_mm, 3)},
      {"span_mm", "span [mm]", decimals(row.span_mm, 1)},
      {"tau2_s", "tau2 [s]", decimals(row.tau2_s, 2)},
      {"k2_kpa_per_mm", "k2 [bar/mm]", in_bar(row.k2_kpa_per_mm)},
      {"c2_kpa_s_per_mm", "c2 [bar s/mm]", in_bar(row.c2_kpa_s_per_mm)},
      {"inverse_refused", "inverse", shown(row.refused, row.refused ? "refused" : "exists")},
      {"parameters", parameters_of(row.fitted)}};
}

Fields fields_of(const PublishedMatch& row) {
  return {{"eta_per_bar", "eta [1/bar]", row.eta_per_bar},
          {"rmse_mm", "RMSE [mm]", decimals(row.rmse_mm, 4)},
          {"rmse_unseen_mm", "on tp2, unseen [mm]", decimals(row.other_rmse_mm, 4)},
          {"span_mm", "span [mm]", decimals(row.span_mm, 1)},
          {"lag_s", "lag [s]", decimals(row.lag_s, 3)},
          {"delay_s", "delay [s]", decimals(row.delay_s, 3)},
          {"", "lag + delay [s]", decimals(row.lag_s + row.delay_s, 3)},
          {"ratio", "beta / (alpha + 1/k0)", decimals(row.ratio, 3)},
          {"parameters", parameters_of(row.model)}};
}

Fields fields_of(const InverseTrial& row) {
  return {{"beta_over_alpha", "beta/alpha", number(row.ratio, 3)},
          {"explicit_growth_per_sample", "explicit form: error growth per sample", number(row.growth, 3)},
          {"explicit_error_kpa", "explicit: error [kPa]", number(row.explicit_error_kpa, 2)},
          {"implicit_error_kpa", "implicit: error [kPa]", number(row.implicit_error_kpa, 2)},
          {"implicit_jump_kpa", "implicit: jump [kPa]", number(row.implicit_jump_kpa, 3)},
          {"true_jump_kpa", "true: jump [kPa]", number(row.true_jump_kpa, 2)},
          {"unreached_share", "not reached",
           shown(row.unreached_share, fixed(100 * row.unreached_share, 0) + " %", true)},
          {"refused", "inverse", shown(row.refused, row.refused ? "refused" : "exists")}};
}

Fields fields_of(const PaperRow& row) {
  const auto figure = [](const PaperFigure& f) {
    return shown(f.rmse_mm, fixed(f.rmse_mm, 3) + " (" + fixed(f.rmse_percent_of_span, 2) + ")", true);
  };
  return {{"signal", "signal", model::name_of(row.signal)},
          {"paper_mm", "the paper's finger", decimals(row.paper_mm, 3)},
          {"published_mm", "finger = published model", figure(row.published)},
          {"published_percent_of_span", row.published.rmse_percent_of_span},
          {"bench_twin_mm", "finger = bench_twin (latency)", figure(row.twin)},
          {"bench_twin_percent_of_span", row.twin.rmse_percent_of_span}};
}

std::string published_json(const PublishedStudy& study) {
  return result::json_text({{"schema", 1},
                            {"software", sysid::software_and_version()},
                            {"seed", study.options.seed},
                            {"rate_hz", study.options.rate_hz},
                            {"noise_mm", study.options.noise_mm},
                            {"starts", study.options.starts},
                            {"hidden_latency", list_of(study.latency)},
                            {"published_response", list_of(study.matches)},
                            {"inverse", list_of(study.inverses)},
                            {"paper_rmse", list_of(study.paper)},
                            {"published", Fields{{"ratio", study.published_ratio},
                                                 {"bench_twin_rmse_mm", study.twin_rmse_mm},
                                                 {"falls_by_mm", study.falls_by_mm},
                                                 {"falls_until_kpa", study.falls_until_kpa},
                                                 {"back_at_kpa", study.back_at_kpa},
                                                 {"bouc_wen_refusal", study.bouc_wen_refusal},
                                                 {"full_model_refusal", study.full_model_refusal}}},
                            {"wall_s", study.wall_s}});
}

}  // namespace softgrip::studies
