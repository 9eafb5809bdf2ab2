// Formats the control study as text for a terminal and as JSON.

#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "bench/studies/control_study.h"
#include "bench/studies/models.h"
#include "bench/studies/study_text.h"
#include "sysid/pages/page.h"

namespace softgrip::studies {
namespace {

using Json = nlohmann::ordered_json;

Json spread_json(const Spread& spread) {
  return {{"median", spread.median}, {"ci90", {spread.low, spread.high}}};
}

Json figure_json(const ControlFigure& figure) {
  return {{"frequency_hz", figure.frequency_hz},
          {"mismatch", figure.mismatch},
          {"amplitude_mm", figure.amplitude_mm},
          {"rmse_mm", spread_json(figure.rmse_mm)},
          {"largest_error_mm", spread_json(figure.most_mm)},
          {"percent_of_stroke", figure.percent_of_stroke},
          {"pressure_mean_kpa", figure.pressure_mean_kpa},
          {"pressure_most_kpa", figure.pressure_most_kpa},
          {"out_of_reach_share", figure.out_of_reach_share},
          {"kp_kpa_per_mm", figure.pid.kp_kpa_per_mm},
          {"ki_kpa_per_mm_s", figure.pid.ki_kpa_per_mm_s},
          {"kd_kpa_s_per_mm", figure.pid.kd_kpa_s_per_mm},
          {"derivative_filter_s", figure.pid.derivative_filter_s},
          {"sensitivity", figure.sensitivity},
          {"limited_by", figure.limited_by},
          {"draws_rmse_mm", figure.draws_mm}};
}

}  // namespace

std::string control_text(const ControlStudy& study) {
  std::string text =
      "Twin, " + significant(study.options.mean_mm) + " ± " + significant(study.options.amplitude_mm) +
      " mm, " + significant(study.options.rate_hz) + " Hz, noise " + significant(study.options.noise_mm) +
      " mm, " + std::to_string(study.options.draws) +
      " fingers; RMSE: median [5 %, 95 %]; gains of all schemes from one tuner, sensitivity peak Ms <= " +
      significant(study.options.most_sensitivity) + "\nIdentified: published structure RMSE " +
      fixed(study.identified_rmse_mm, 3) + " mm, beta/(alpha+1/k0) " +
      significant(wrong_way_ratio(study.identified), 3) + "; extended RMSE " +
      fixed(study.extended_rmse_mm, 3) + " mm, " + significant(wrong_way_ratio(study.extended), 3) + "\n";
  for (const ControlScheme& scheme : study.schemes) {
    text += scheme.id + ": " + scheme.about + "\n";
    if (!scheme.refusal.empty()) text += "   refused: " + scheme.refusal + "\n";
    for (const ControlFigure& f : scheme.figures) {
      text += "   " + cell(fixed(f.frequency_hz, 2), 4) + " Hz, " + significant(f.amplitude_mm) + " mm  ±" +
              cell(fixed(100 * f.mismatch, 0), 2) + " %  RMSE " + cell(fixed(f.rmse_mm.median, 4), 7) + " [" +
              fixed(f.rmse_mm.low, 4) + ", " + fixed(f.rmse_mm.high, 4) + "] mm " +
              cell(fixed(f.percent_of_stroke, 2), 6) + " % of stroke  largest " +
              cell(fixed(f.most_mm.median, 3), 6) + " mm  pressure " + fixed(f.pressure_mean_kpa, 1) + " / " +
              fixed(f.pressure_most_kpa, 1) + " kPa  Ms " + fixed(f.sensitivity, 2) + "  kp " +
              significant(f.pid.kp_kpa_per_mm, 3) + " ki " + significant(f.pid.ki_kpa_per_mm_s, 3) + " kd " +
              significant(f.pid.kd_kpa_s_per_mm, 2) +
              (f.out_of_reach_share > 0.001 ? "  out of reach " + fixed(100 * f.out_of_reach_share, 0) + " %"
                                            : "") +
              "\n";
    }
  }
  return text + "seed " + std::to_string(study.options.seed) + ", " + significant(study.wall_s, 3) + " s\n";
}

std::string control_json(const ControlStudy& study) {
  Json json;
  json["schema"] = 1;
  json["software"] = sysid::software_and_version();
  json["seed"] = study.options.seed;
  json["draws"] = study.options.draws;
  json["rate_hz"] = study.options.rate_hz;
  json["noise_mm"] = study.options.noise_mm;
  json["mean_mm"] = study.options.mean_mm;
  json["amplitude_mm"] = study.options.amplitude_mm;
  json["most_sensitivity"] = study.options.most_sensitivity;
  json["identified"] = {{"rmse_mm", study.identified_rmse_mm},
                        {"ratio", wrong_way_ratio(study.identified)},
                        {"parameters", result::json_of(parameters_of(study.identified))}};
  json["extended"] = {{"rmse_mm", study.extended_rmse_mm},
                      {"ratio", wrong_way_ratio(study.extended)},
                      {"parameters", result::json_of(parameters_of(study.extended))}};
  json["schemes"] = Json::array();
  for (const ControlScheme& scheme : study.schemes) {
    Json entry{{"id", scheme.id}, {"about", scheme.about}};
    entry["refused"] = scheme.refusal.empty() ? Json(nullptr) : Json(scheme.refusal);
    entry["figures"] = Json::array();
    for (const ControlFigure& figure : scheme.figures) entry["figures"].push_back(figure_json(figure));
    json["schemes"].push_back(std::move(entry));
  }
  json["wall_s"] = study.wall_s;
  return json.dump(2) + "\n";
}

}  // namespace softgrip::studies
