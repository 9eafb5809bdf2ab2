#include "sysid/diagnosis/report/report_sections.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "model/blocks/stress_softening.h"
#include "model/blocks/valve_deadband.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid::report_valve_test {
namespace {

ValveFindings dead_band_found() {
  NamedCause named;
  named.cause = *find_cause(causes::ValveDeadband::id);
  named.block_type = model::block_type<model::ValveDeadband>();
  named.parameters.push_back({"band_kpa", "kPa", 1.25, {1.125, 1.375}, true});
  named.gain_percent = {31, 3, 25, 37};
  named.gain_kpa2 = Spread{0.45, 0.1, 0.25, 0.65};
  ValveFindings found;
  found.named.push_back(named);
  found.stage.delay_s = 0.018;
  found.heldout_rmse_kpa = 0.63;
  return found;
}

TEST(ReportValve, StatesEachParameterWithIntervalAndResidual) {
  Page page("title", "sentence", Tone::bad);
  add_valve_section(page, dead_band_found());
  const std::string html = page.to_html();
  for (const char* text : {"the measured pressure", "Valve dead band", "band_kpa", "1.25", "1.125 to 1.375",
                           "0.018", "0.63 kPa on held-out blocks", "31 (25 to 37)"}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
}

TEST(ReportValve, HasNoParameterTableWithoutACause) {
  Page page("title", "sentence", Tone::good);
  ValveFindings nothing = dead_band_found();
  nothing.named.clear();
  add_valve_section(page, nothing);
  EXPECT_EQ(page.to_html().find("band_kpa"), std::string::npos);
  EXPECT_NE(page.to_html().find("0.018"), std::string::npos);
  EXPECT_EQ(page.to_html().find("does not match this structure"), std::string::npos);
  nothing.stage.rmse_percent = 8;
  add_valve_section(page, nothing);
  EXPECT_NE(page.to_html().find("does not match this structure"), std::string::npos);
}

TEST(DiagnosisJson, HasDeprecatedKeysBesideTheirReplacements) {
  Diagnosis d;
  d.unexplained_recalibrated.excess_mm = 0.5;
  EXPECT_TRUE(result::json_of(fields_of(d)).at("stick_slip").is_null());
  d.stick_slip.emplace().jumps = 7;
  d.evidence.emplace().recalibrated.structure_mm = 0.25;
  d.evidence->recalibrated.memory_s = 1.5;
  d.evidence->unphysical = {{"inverse_response", "a sentence", 2, 1, "wrong_way_first"},
                            {"at_bound", "a sentence", 0, 0}};
  d.stick_slip->gain_percent = d.gain = {12, 3, 10, 14};
  d.base = "two creep branches";
  d.causes.emplace_back().gain_percent = {40, 5, 30, 50};
  d.causes.back().cause = *find_cause("stress_softening");
  d.causes.back().block_type = model::block_type<model::StressSoftening>();
  d.causes.back().parameters = {
      {"saturation_per_kpa", "1/kPa", 0.02, {0.01, 0.03}, true, "levelling_per_kpa"},
      {"softening_per_kpa", "1/kPa", 0.004, {0.003, 0.005}, true}};
  const auto json = result::json_of(fields_of(d));
  EXPECT_EQ(json.at("stick_slip").at("jumps"), 7);
  EXPECT_EQ(json.at("staircase"), json.at("stick_slip"));
  EXPECT_EQ(json.at("unexplained_rms_mm").at("recalibrated"), 0.5);
  EXPECT_EQ(json.at("structure_mm"), json.at("unexplained_rms_mm"));
  const auto& residual = json.at("evidence").at("recalibrated");
  EXPECT_EQ(residual.at("unexplained_rms_mm"), 0.25);
  EXPECT_EQ(residual.at("structure_mm"), 0.25);
  EXPECT_EQ(residual.at("correlation_time_s"), 1.5);
  EXPECT_EQ(residual.at("memory_s"), 1.5);
  const auto& signs = json.at("evidence").at("unphysical_recalibration");
  EXPECT_EQ(signs.at(0).at("name"), "inverse_response");
  EXPECT_EQ(signs.at(0).at("id"), "wrong_way_first");
  EXPECT_EQ(signs.at(1).at("name"), "at_bound");
  EXPECT_EQ(signs.at(1).at("id"), "at_bound");
  for (const auto* const place : {&json, &json.at("stick_slip")}) {
    EXPECT_EQ(place->at("error_reduction_percent").at("value"), 12);
    EXPECT_EQ(place->at("gain_percent"), place->at("error_reduction_percent"));
  }
  EXPECT_EQ(json.at("structure"), "two creep branches");
  EXPECT_EQ(json.at("base"), json.at("structure"));
  const auto& cause = json.at("causes").at(0);
  EXPECT_EQ(cause.at("heldout_error_reduction_percent").at("value"), 40);
  EXPECT_EQ(cause.at("heldout_error_reduction_percent").at("ci95").at(1), 50);
  EXPECT_EQ(cause.at("heldout_gain_percent"), cause.at("heldout_error_reduction_percent"));
  const auto& parameters = cause.at("parameters");
  EXPECT_EQ(parameters.size(), 3U);
  EXPECT_EQ(parameters.at("saturation_per_kpa").at("value"), 0.02);
  EXPECT_EQ(parameters.at("levelling_per_kpa"), parameters.at("saturation_per_kpa"));
}

TEST(DiagnosisJson, IsWrittenIfThePathOfALogIsNotUtf8) {
  Diagnosis d;
  d.runs = {{"sp2\xff", 0.1, 0.1, 0.1}};
  EXPECT_NE(result::json_text(fields_of(d)).find("\"run\": \"sp2\xef\xbf\xbd\""), std::string::npos);
}

TEST(DiagnosisJson, ValveCauseFromMeasuredPressureIsListedInCauses) {
  Diagnosis d;
  d.verdict = Verdict::adequate;
  EXPECT_EQ(result::json_of(fields_of(d))["verdict"], "adequate");
  EXPECT_TRUE(result::json_of(fields_of(d))["valve"].is_null());
  d.in_valve = dead_band_found();
  const auto json = result::json_of(fields_of(d));
  EXPECT_EQ(json["verdict"], "cause_found");
  ASSERT_EQ(json["causes"].size(), 1U);
  EXPECT_EQ(json["alternatives"].size(), 1U);
  EXPECT_EQ(json["causes"][0]["id"], "valve_deadband");
  EXPECT_EQ(json["causes"][0]["judged_by"], "pressure_kpa");
  EXPECT_EQ(json["causes"][0]["gain_kpa2"]["value"], 0.45);
  EXPECT_EQ(json["valve"]["heldout_rmse_kpa"], 0.63);
  EXPECT_NE(verdict_sentence(d).find("valve dead band (band_kpa 1.25)"), std::string::npos)
      << verdict_sentence(d);
  d.verdict = Verdict::unexplained;
  EXPECT_EQ(result::json_of(fields_of(d))["verdict"], "partly_explained");
}

TEST(DiagnosisJson, ValveOfAClosedLoopHasNullForValuesThatWereNotMeasured) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  Diagnosis d;
  d.verdict = Verdict::partly_explained;
  d.recalibrated_rmse_mm = 0.33;
  d.extended_rmse_mm = 0.086;
  d.loop_bands_kpa = {2.7};
  NamedCause& valve = d.causes.emplace_back();
  valve.cause = *find_cause(causes::ValveDeadband::id);
  valve.block_type = model::block_type<model::ValveDeadband>();
  valve.parameters = {{"band_kpa", "kPa", 2.7, {}, false}};
  valve.gain_percent = valve.gain_mm2 = {unknown, unknown, unknown, unknown};
  valve.inclusion = unknown;
  valve.only_in_loop = true;
  const auto json = result::json_of(fields_of(d));
  const auto& cause = json.at("causes").at(0);
  for (const auto* const spread :
       {&cause.at("heldout_error_reduction_percent"), &cause.at("heldout_gain_percent"),
        &json.at("budget").at("causes").at("valve_deadband")}) {
    EXPECT_EQ(spread->dump(), R"({"value":null,"ci95":null})");
  }
  EXPECT_TRUE(cause.at("inclusion").is_null());
  EXPECT_TRUE(cause.at("share_percent").is_null());
  EXPECT_EQ(cause.at("parameters").at("band_kpa").dump(), R"({"value":2.7,"ci95":null})");
  EXPECT_EQ(cause.at("judged_by"), "one_step_prediction");
  EXPECT_EQ(cause.at("in_extended_model"), false);
  d.extended_model.blocks.push_back({valve.block_type, {2.7}});
  EXPECT_EQ(result::json_of(fields_of(d)).at("causes").at(0).at("in_extended_model"), true);
}

TEST(DiagnosisJson, ValveCauseWithAPressureScaleAlternativeIsAmbiguous) {
  Diagnosis d;
  d.verdict = Verdict::recalibrate;
  d.in_valve = dead_band_found();
  d.in_valve->named.front().alternatives = {*find_cause("pressure_scale")};
  const auto json = result::json_of(fields_of(d));
  EXPECT_EQ(json["verdict"], "ambiguous");
  ASSERT_EQ(json["alternatives"][0].size(), 1U);
  EXPECT_EQ(json["alternatives"][0][0], "pressure_scale");
  EXPECT_NE(verdict_sentence(d).find("valve dead band or pressure scale"), std::string::npos);
  Page page("title", "sentence", Tone::bad);
  add_valve_section(page, *d.in_valve);
  EXPECT_NE(page.to_html().find("Valve dead band or pressure scale"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::sysid::report_valve_test
