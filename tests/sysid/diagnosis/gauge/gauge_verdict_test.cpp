// Tests a diagnosis from logs with a gauge check of the sensor. The gauge check can rule out alternatives,
// replace the named cause, or withdraw it.

#include "sysid/diagnosis/gauge/gauge_verdict.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "sysid/diagnosis/experiments/experiment.h"
#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::gauge_verdict_test {
namespace {

constexpr double noise_mm = 0.04;

model::Model hiding(const char* id, std::vector<double> values) {
  return model::with_block(loaded("bench_twin"), {find_cause(id)->forms.front().type, std::move(values)});
}
const model::Model bent_scale = hiding("sensor_nonlinearity", {0.6, 0, 25});
const model::Model stiff_finger = hiding("stiffening", {0.012});
const model::Model ending_sensor = hiding("sensor_saturation", {-1e4, 17});

std::vector<Log> logs_of(const model::Model& truth) {
  return {simulated(truth, model::SignalName::tp1, 25, noise_mm, 1),
          simulated(truth, model::SignalName::sp2, 25, noise_mm, 2)};
}

/// Returns the readings of a gauge check. The sensor is the one in the model `truth`.
GaugeFile gauge_of(const model::Model& truth, double noise = 0.01) {
  const SensorShape sensor{static_sensor_blocks(truth), 0};
  GaugeFile file{"gauge.csv", "", {}};
  for (const double position : planned_positions(24)) {
    const double error = noise * normal_at(3, file.readings.size());
    file.readings.push_back({position, sensor.at(position) + error, 200});
  }
  return file;
}

Diagnosis diagnosed(const model::Model& truth, std::optional<GaugeFile> gauge,
                    const model::Model& given = loaded("bench_twin")) {
  DiagnosisOptions options;
  options.gauge = std::move(gauge);
  return diagnose(logs_of(truth), given, options).value();
}

bool warned_of(const Diagnosis& d, const std::string& words) {
  return std::any_of(d.warnings.begin(), d.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

void expect_found(const Diagnosis& d, const std::string& id) {
  EXPECT_EQ(d.verdict, Verdict::cause_found) << verdict_sentence(d);
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes[0].cause.id, id);
  EXPECT_TRUE(d.causes[0].alternatives.empty());
  // The extended model, its parameters and its held-out errors must belong to the named cause.
  EXPECT_TRUE(model::position_of(d.extended_model, id));
  ASSERT_EQ(d.extended.causes.size(), 1U);
  EXPECT_EQ(d.extended.causes[0].id, id);
  EXPECT_GT(d.causes[0].gain_percent.lower, 0);
  EXPECT_NEAR(d.causes[0].gain_percent.value, d.gain.value, 1);
  EXPECT_LT(d.extended_rmse_mm, d.recalibrated_rmse_mm);
}

double value_of(const NamedCause& named, const std::string& parameter) {
  for (const CauseParameter& p : named.parameters) {
    if (p.name == parameter) return p.value;
  }
  return NAN;
}

/// Tests the content of the key `gauge` in diagnosis.json.
void expect_gauge(const nlohmann::ordered_json& json, const GaugeFile& gauge) {
  EXPECT_EQ(json["file"], "gauge.csv");
  EXPECT_EQ(json["readings"].size(), gauge.readings.size());
  EXPECT_EQ(json["ruled_out"], nlohmann::ordered_json({"stiffening"}));
  EXPECT_GT(json["log_likelihood_ratio"], gauge_log_likelihood_needed);
  EXPECT_EQ(json["hypotheses"].size(), 2U);
}

/// Tests that the diagnosis proposes a gauge check and no other experiment.
void expect_check_proposed(const Diagnosis& before) {
  const NextExperiment next = design_experiment(before, {});
  EXPECT_FALSE(next.best);
  ASSERT_TRUE(next.gauge_check);
  EXPECT_EQ(next.gauge_check->separates.size(), 2U);
  EXPECT_GE(next.gauge_check->positions_mm.size(), 27U);
  EXPECT_NEAR(next.gauge_check->minutes, static_cast<double>(next.gauge_check->positions_mm.size()) / 3,
              1e-9);
  EXPECT_NE(next.advice.front().find("--gauge"), std::string::npos) << next.advice.front();
  result::Fields fields = fields_of(before);
  ASSERT_TRUE(result::json_of(fields).contains("gauge"));
  EXPECT_TRUE(result::json_of(fields)["gauge"].is_null());
  for (result::Field& field : fields_of(next)) fields.push_back(field);
  const auto json = result::json_of(fields);
  EXPECT_TRUE(json["next_experiment"].is_null());
  EXPECT_EQ(json["gauge_check"]["file"], "gauge_positions.csv");
}

TEST(GaugeVerdict, ProposedGaugeCheckNamesSensorNonlinearity) {
  const Diagnosis before = diagnosed(bent_scale, std::nullopt);
  ASSERT_EQ(before.verdict, Verdict::ambiguous) << verdict_sentence(before);
  expect_check_proposed(before);
  const GaugeFile gauge = gauge_of(bent_scale);
  const Diagnosis d = diagnosed(bent_scale, gauge);
  expect_found(d, "sensor_nonlinearity");
  EXPECT_NEAR(value_of(d.causes[0], "bow_mm"), 0.6, 0.25);
  EXPECT_EQ(d.gauge->ruled_out, (std::vector<std::string>{"stiffening"}));
  expect_gauge(result::json_of(fields_of(d))["gauge"], gauge);
}

TEST(GaugeVerdict, LinearSensorLeavesStiffeningAsTheCause) {
  const Diagnosis d = diagnosed(stiff_finger, gauge_of(stiff_finger));
  expect_found(d, "stiffening");
  EXPECT_NEAR(value_of(d.causes[0], "stiffening_per_mm"), 0.012, 0.002);
  EXPECT_EQ(d.gauge->ruled_out, (std::vector<std::string>{"sensor_nonlinearity"}));
  EXPECT_NE(verdict_sentence(d).find("not the sensor"), std::string::npos) << verdict_sentence(d);
}

/// The logs cannot separate a nonlinear sensor from a stiffening finger, so the gauge check decides. In the
/// first case, the logs come from a nonlinear sensor and the gauge readings from a linear sensor. In the
/// second case, the logs come from a stiffening finger and the gauge readings from a nonlinear sensor.
TEST(GaugeVerdict, RuledOutCauseIsReplacedByTheAlternative) {
  const model::Model alike = hiding("stiffening", {4 * 0.6 / (25 * 25)});
  expect_found(diagnosed(bent_scale, gauge_of(alike)), "stiffening");
  expect_found(diagnosed(alike, gauge_of(bent_scale)), "sensor_nonlinearity");

  // This finger stiffens more sharply than the stiffening block of the catalogue. For this reason, the block
  // of a nonlinear sensor fits the logs better.
  std::vector<Log> logs;
  for (const model::SignalName signal : {model::SignalName::tp1, model::SignalName::sp2}) {
    Log& log = logs.emplace_back(simulated(loaded("bench_twin"), signal, 25, 0, 1));
    for (std::size_t i = 0; i < log.size(); ++i) {
      double& y = log.displacement_mm[i];
      y = y * (1 - 0.0003 * y * y) + noise_mm * normal_at(7, i);
    }
  }
  DiagnosisOptions options;
  const Diagnosis before = diagnose(logs, loaded("bench_twin"), options).value();
  ASSERT_EQ(before.verdict, Verdict::ambiguous);
  ASSERT_EQ(before.causes[0].cause.id, "sensor_nonlinearity");
  options.gauge = gauge_of(loaded("bench_twin"));
  const Diagnosis after = diagnose(logs, loaded("bench_twin"), options).value();
  expect_found(after, "stiffening");
  EXPECT_TRUE(after.gauge->replaced);
  for (const CandidateScore& tried : before.causes[0].candidates) {
    if (tried.cause.id != "stiffening") continue;
    EXPECT_NEAR(after.extended_rmse_mm, tried.heldout_rmse_mm, 0.01 * tried.heldout_rmse_mm);
    EXPECT_GT(after.extended_rmse_mm, 1.05 * before.extended_rmse_mm);
  }
  EXPECT_TRUE(warned_of(after, "leaves an unexplained error of")) << after.unexplained_error.excess_mm;
}

/// The finger stiffens, and the sensor is slightly nonlinear. The diagnosis must name the stiffening as the
/// cause, and a warning must report the nonlinear sensor.
TEST(GaugeVerdict, SmallSensorNonlinearityIsReportedAsAWarning) {
  const model::Model a_little = hiding("sensor_nonlinearity", {0.3, 0, 25});
  const Diagnosis d = diagnosed(stiff_finger, gauge_of(a_little));
  expect_found(d, "stiffening");
  EXPECT_TRUE(warned_of(d, "Calibrate the sensor")) << verdict_sentence(d);
}

TEST(GaugeVerdict, GaugeNamesSensorSaturationInsteadOfAStop) {
  const Diagnosis d = diagnosed(ending_sensor, gauge_of(ending_sensor));
  expect_found(d, "sensor_saturation");
  EXPECT_NEAR(value_of(d.causes[0], "upper_mm"), 17, 0.05);
}

TEST(GaugeVerdict, GaugeNamesAStopInsteadOfSensorSaturation) {
  const model::Model stop = hiding("contact", {17, 1e5});
  const Diagnosis before = diagnosed(stop, std::nullopt);
  ASSERT_EQ(before.verdict, Verdict::ambiguous) << verdict_sentence(before);
  const Diagnosis d = diagnosed(stop, gauge_of(stop));
  expect_found(d, "contact");
  EXPECT_NEAR(value_of(d.causes[0], "position_mm"), 17, 0.05);
}

TEST(GaugeVerdict, DifferentNonlinearityLeavesTheVerdictAmbiguous) {
  const model::Model other = hiding("sensor_nonlinearity", {2.4, 0, 25});
  const Diagnosis d = diagnosed(bent_scale, gauge_of(other));
  EXPECT_EQ(d.verdict, Verdict::ambiguous);
  EXPECT_TRUE(d.gauge->ruled_out.empty());
  EXPECT_TRUE(warned_of(d, "fit no explanation"));
  EXPECT_NE(verdict_sentence(d).find(
                "but the shape of this nonlinearity does not agree with the nonlinearity in these logs"),
            std::string::npos)
      << verdict_sentence(d);
}

TEST(GaugeVerdict, NoisyGaugeIsUndecidedAndNotProposedAgain) {
  const Diagnosis d = diagnosed(bent_scale, gauge_of(bent_scale, 1.5));
  EXPECT_EQ(d.verdict, Verdict::ambiguous);
  EXPECT_EQ(d.gauge->check.outcome, GaugeOutcome::undecided);
  EXPECT_NE(verdict_sentence(d).find("does not decide"), std::string::npos);
  const NextExperiment again = design_experiment(d, {});
  EXPECT_FALSE(again.gauge_check) << "the gauge check has already been made, so it must not be proposed";
  ASSERT_FALSE(again.advice.empty());
  EXPECT_NE(again.advice.front().find("change the load"), std::string::npos);
}

TEST(GaugeVerdict, NonlinearityAbsentFromTheLogsIsOnlyAWarning) {
  const model::Model finger = hiding("backlash", {1});
  const Diagnosis d = diagnosed(finger, gauge_of(bent_scale));
  EXPECT_EQ(d.verdict, Verdict::cause_found) << verdict_sentence(d);
  ASSERT_FALSE(d.causes.empty());
  EXPECT_EQ(d.causes[0].cause.id, "backlash");
  EXPECT_TRUE(warned_of(d, "Calibrate the sensor first"));
  const Diagnosis straight = diagnosed(finger, gauge_of(finger));
  EXPECT_FALSE(warned_of(straight, "Calibrate the sensor"));
  EXPECT_EQ(straight.verdict, d.verdict);
}

/// If there is backlash between finger and sensor, the logs alone show that the finger stiffens and that the
/// sensor is linear. A gauge check that shows a nonlinear sensor contradicts the logs. In this case, the
/// diagnosis must not name stiffening without alternatives.
TEST(GaugeVerdict, NonlinearGaugeMakesASoleStiffeningCauseAmbiguous) {
  const model::BlockSpec play{find_cause("backlash")->forms.front().type, {4}};
  const model::Model given = model::with_block(loaded("bench_twin"), play);
  const model::Model truth = model::with_block(stiff_finger, play);
  const auto stands = [](const Diagnosis& d) {
    return std::any_of(d.causes.begin(), d.causes.end(), [](const NamedCause& c) {
      return c.cause.id == "stiffening" && c.alternatives.empty();
    });
  };
  const Diagnosis alone = diagnosed(truth, std::nullopt, given);
  ASSERT_TRUE(stands(alone)) << verdict_sentence(alone);
  EXPECT_TRUE(stands(diagnosed(truth, gauge_of(stiff_finger), given)));
  for (const double bow_mm : {1.4, 5.0}) {
    const Diagnosis d = diagnosed(truth, gauge_of(hiding("sensor_nonlinearity", {bow_mm, 0, 25})), given);
    EXPECT_FALSE(stands(d)) << bow_mm << ": " << verdict_sentence(d);
    EXPECT_EQ(d.verdict, Verdict::ambiguous) << bow_mm;
    EXPECT_TRUE(warned_of(d, "gauge")) << bow_mm;
  }
}

}  // namespace
}  // namespace softgrip::sysid::gauge_verdict_test
