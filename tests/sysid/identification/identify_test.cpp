#include "sysid/identification/identify.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/combinations.h"
#include "sysid/identification/validate.h"
#include "tests/sysid/integrated.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::identify_test {
namespace {

using model::Model;
using model::SignalName;

const Estimate& find(const std::vector<Estimate>& list, std::string_view name) {
  for (const Estimate& e : list) {
    if (e.name == name) return e;
  }
  throw std::runtime_error("no estimate " + std::string(name));
}

/// Compares each parameter combination of the true model with its confidence interval. The difference to the
/// estimate must be below `widths` half-widths of the interval.
void expect_truth(const Identification& result, const Model& truth, double widths) {
  for (const Combination& c : combinations_of(truth)) {
    const Estimate& e = find(result.combinations, c.name);
    ASSERT_TRUE(e.ci95) << c.name;
    const double half = (e.ci95->upper - e.ci95->lower) / 2;
    EXPECT_NEAR(e.value, c.value(truth), widths * half) << c.name;
  }
}

std::vector<Log> two_logs(const Model& truth, double rate_hz = 50, double noise_mm = 0.05) {
  return {simulated(truth, SignalName::tp1, rate_hz, noise_mm, 11),
          simulated(truth, SignalName::sp2, rate_hz, noise_mm, 12)};
}

TEST(WrongWaySentence, StatesNoRatioThatIsRoundedToOne) {
  EXPECT_EQ(wrong_way_sentence(1.0004).find("beta / (alpha + 1/k0) is slightly above 1, so"), 0U);
  EXPECT_EQ(wrong_way_sentence(1.01).find("beta / (alpha + 1/k0) = 1.01 is above 1, so"), 0U);
  EXPECT_EQ(wrong_way_sentence(5000).find("beta / (alpha + 1/k0) is far above 1, so"), 0U);
}

TEST(IntervalText, StatesIfTheLogsDoNotDetermineTheValue) {
  EXPECT_EQ(text_of({0.127, 0.133}, 0.13, " .. "), "0.127 .. 0.133");
  EXPECT_EQ(text_of({-1, 1}, 0.2, " to "), "-1 to 1");
  EXPECT_EQ(text_of({1e-191, 1e187}, 0.015, " .. "), "not determined by these logs");
  EXPECT_EQ(text_of({-3, 3}, 0.2, " .. "), "not determined by these logs");
}

TEST(Identify, RecoversTheBaseModelFromDataAlone) {
  const Model truth = scattered(loaded("zhang2025"), 0.05, 1);
  const auto logs = two_logs(truth);
  const auto result = identify(logs, base_model(logs, 2));
  ASSERT_TRUE(result) << result.error();
  EXPECT_TRUE(result->converged);
  EXPECT_NEAR(result->rmse_mm, 0.05, 0.02 * 0.05);
  EXPECT_GE(result->multistart.share_at_best, 0.2);
  expect_truth(*result, truth, 2);
}

TEST(Identify, RecoversTheLatencyOfTheModelStructure) {
  const Model truth = scattered(loaded("bench_twin"), 0.05, 2);
  const auto result = identify(two_logs(truth), loaded("bench_twin"));
  ASSERT_TRUE(result) << result.error();
  EXPECT_NEAR(result->rmse_mm, 0.05, 0.02 * 0.05);
  expect_truth(*result, truth, 2);
}

/// In MPa, the same finger moves 1000 times as far per unit of pressure. The limits of the parameters contain
/// such a gain.
TEST(Identify, TheUnitOfThePressureDoesNotMatter) {
  std::vector<Log> logs = two_logs(scattered(loaded("zhang2025"), 0.05, 1));
  for (Log& log : logs) {
    for (double& p : log.pressure_command_kpa) p /= 1000;
  }
  const auto result = identify(logs, base_model(logs, 2));
  ASSERT_TRUE(result) << result.error();
  EXPECT_NEAR(result->rmse_mm, 0.05, 0.02 * 0.05);
}

/// The gain of this rig is 1000 times that of a finger, as if its readings were in micrometres.
TEST(Identify, TheUnitOfTheDisplacementDoesNotMatter) {
  std::vector<Log> logs = two_logs(scattered(loaded("zhang2025"), 0.05, 1));
  for (Log& log : logs) {
    for (double& y : log.displacement_mm) y *= 1000;
  }
  const auto result = identify(logs, base_model(logs, 2));
  ASSERT_TRUE(result) << result.error();
  EXPECT_NEAR(result->rmse_mm, 50, 0.02 * 50);
}

/// The central example of the project: if the model structure has no latency, the hysteresis block absorbs
/// the latency of the rig.
TEST(Identify, MissingLatencyMakesTheModelNotInvertible) {
  const auto logs = two_logs(loaded("bench_twin"));
  const auto result = identify(logs, base_model(logs, 2));
  ASSERT_TRUE(result) << result.error();
  EXPECT_GT(find(result->combinations, "beta_over_instantaneous_gain").value, 1.5);
  EXPECT_LT(result->scores.front().rmse_percent_of_span, 1);
  EXPECT_TRUE(std::any_of(result->warnings.begin(), result->warnings.end(),
                          [](const std::string& w) { return w.find("latency") != std::string::npos; }));
}

/// The logs were simulated by a program that shares no code with the models. Its integration method and its
/// time step differ from those of the models.
TEST(Identify, RecoversParametersOfAnIndependentSimulation) {
  const IntegratedFinger finger;
  const std::vector<Log> logs{integrated(finger, SignalName::tp1, 50, 0.05, 21),
                              integrated(finger, SignalName::tp2, 50, 0.05, 22)};
  const auto result = identify(logs, base_model(logs, 2));
  ASSERT_TRUE(result) << result.error();
  EXPECT_NEAR(result->rmse_mm, 0.05, 0.02 * 0.05);
  const std::vector<std::pair<std::string, double>> truth{
      {"instantaneous_gain_mm_per_kpa", finger.alpha + 1 / finger.k0},
      {"hysteresis_limit_mm", finger.beta / (finger.gamma + finger.eta)},
      {"saturation_growing_per_kpa", finger.gamma + finger.eta},
      {"saturation_shrinking_per_kpa", finger.gamma - finger.eta},
      {"branch1_time_constant_s", finger.c1 / finger.k1},
      {"branch2_time_constant_s", finger.c2 / finger.k2},
      {"branch1_gain_mm_per_kpa", 1 / finger.k1},
      {"branch2_gain_mm_per_kpa", 1 / finger.k2}};
  for (const auto& [name, value] : truth) {
    const Estimate& e = find(result->combinations, name);
    EXPECT_TRUE(e.identifiable) << name;
    EXPECT_NEAR(e.value, value, (e.ci95->upper - e.ci95->lower)) << name;
  }
}

TEST(Identify, AlphaAndK0AreNamedAsASum) {
  const auto result = identify(two_logs(loaded("zhang2025")), loaded("zhang2025"));
  ASSERT_TRUE(result);
  for (const char* name : {"bouc_wen.alpha_mm_per_kpa", "kelvin_voigt.k0_kpa_per_mm"}) {
    const Estimate& e = find(result->parameters, name);
    EXPECT_FALSE(e.identifiable);
    EXPECT_FALSE(e.ci95);
    EXPECT_NE(e.note.find("alpha + 1/k0"), std::string::npos);
  }
  EXPECT_TRUE(find(result->combinations, "instantaneous_gain_mm_per_kpa").identifiable);
}

TEST(Identify, OnlyFreeParametersChange) {
  const Model truth = loaded("bench_twin");
  Model start = truth;
  start.blocks[2].values[1] *= 1.2;
  IdentifyOptions options;
  options.free = {"bouc_wen.beta_mm_per_kpa", "transport_delay.delay_s"};
  options.starts = 3;
  const auto result = identify(two_logs(truth), start, options);
  ASSERT_TRUE(result) << result.error();
  EXPECT_NEAR(result->model.blocks[2].values[1], truth.blocks[2].values[1], 1e-3);
  const auto before = model::flat_values(start);
  const auto after = model::flat_values(result->model);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const std::string path = model::parameter_path(start, i);
    const bool free = path == options.free[0] || path == options.free[1];
    if (!free) {
      EXPECT_EQ(before[i], after[i]) << path;
    }
  }
}

TEST(Identify, FixedK0MakesAlphaIdentifiable) {
  const Model truth = loaded("zhang2025");
  IdentifyOptions options;
  options.fixed = {"kelvin_voigt.k0_kpa_per_mm"};
  const auto result = identify(two_logs(truth), truth, options);
  ASSERT_TRUE(result);
  const Estimate& alpha = find(result->parameters, "bouc_wen.alpha_mm_per_kpa");
  ASSERT_TRUE(alpha.ci95);
  EXPECT_NEAR(alpha.value, truth.blocks[0].values[0], alpha.ci95->upper - alpha.ci95->lower);
}

TEST(Identify, AParameterThatDoesNotExistIsRefused) {
  IdentifyOptions options;
  options.fixed = {"bouc_wen.delta"};
  const auto result = identify(two_logs(loaded("zhang2025")), loaded("zhang2025"), options);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().find("bouc_wen.delta"), std::string::npos);
  EXPECT_NE(result.error().find("kelvin_voigt.k1_kpa_per_mm"), std::string::npos) << result.error();
  options.fixed = {"bouc_wen.gama_per_kpa"};
  EXPECT_EQ(identify(two_logs(loaded("zhang2025")), loaded("zhang2025"), options).error(),
            "the model has no parameter 'bouc_wen.gama_per_kpa'; did you mean 'bouc_wen.gamma_per_kpa'?");
}

/// The log begins in the middle of a run. At its start, the states of hysteresis and creep and the offset of
/// the sensor zero are unknown.
TEST(Identify, EstimatesTheStateInWhichALogBegins) {
  const Model truth = loaded("zhang2025");
  std::vector<Log> logs;
  for (const Log& log : two_logs(truth)) {
    logs.push_back(slice(log, 330, log.size()));
    for (double& y : logs.back().displacement_mm) y += 1.7;
  }
  const auto result = identify(logs, truth);
  ASSERT_TRUE(result) << result.error();
  EXPECT_NEAR(result->rmse_mm, 0.05, 0.03 * 0.05);
  expect_truth(*result, truth, 3);
  EXPECT_FALSE(result->starts.empty());
  IdentifyOptions rest;
  rest.record.start = Start::rest;
  EXPECT_GT(identify(logs, truth, rest)->rmse_mm, 1.5 * result->rmse_mm);
}

/// A fit uses all readings for the state in which a log begins. `validate` uses only the first readings.
TEST(StartWarnings, StateTheErrorThatValidateReports) {
  const Model finger = loaded("zhang2025");
  const Log log = slice(simulated(finger, SignalName::tp1, 50, 0.05, 11), 330, 1000);
  const double validated_mm = validate_logs(finger, {log}, {}).scores.front().rmse_mm;
  Identification result;
  result.fitted = finger;
  result.records = make_records({log}, {});
  for (const double ratio : {1.1, 2.0}) {
    result.scores = {Score()};
    result.scores.front().rmse_mm = validated_mm / ratio;
    const std::vector<std::string> sentences = start_warnings(result);
    ASSERT_EQ(sentences.size(), 1U);
    const std::string& sentence = sentences.front();
    EXPECT_NE(sentence.find("the initial state of this log was estimated"), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find("the RMSE is " + significant(validated_mm, 3)) != std::string::npos, ratio > 1.5)
        << sentence;
  }
}

/// The log has one amplitude and begins under pressure. The data therefore cannot separate the hysteresis
/// from the state at the start, and the information matrix is singular within the rounding errors.
TEST(Identify, ParametersThatTheLogDoesNotDetermineHaveWideIntervals) {
  const Model truth = loaded("zhang2025");
  const Log log = slice(simulated(truth, SignalName::steps, 20, 0.05, 3), 130, 455);
  IdentifyOptions options;
  options.starts = 3;
  const auto result = identify({log}, truth, options);
  ASSERT_TRUE(result) << result.error();
  ASSERT_FALSE(result->loose.empty());
  EXPECT_GT(result->loose.front().deviation, 1000);
  std::vector<Estimate> all = result->parameters;
  all.insert(all.end(), result->starts.begin(), result->starts.end());
  for (const Estimate& e : all) {
    if (!e.ci95) continue;
    EXPECT_GT(e.ci95->upper - e.ci95->lower, 1e-6 * std::abs(e.value)) << e.name;
  }
  for (const std::string& name : result->loose.front().names)
    EXPECT_FALSE(find(all, name).identifiable) << name;
  EXPECT_EQ(find(result->combinations, "saturation_growing_per_kpa").note.find("fixed"), std::string::npos);
}

TEST(Identify, ASensorsZeroIsEstimated) {
  auto logs = two_logs(loaded("zhang2025"));
  for (double& y : logs[1].displacement_mm) y -= 3;
  const auto result = identify(logs, loaded("zhang2025"));
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->rmse_mm, 0.05, 0.02 * 0.05);
  EXPECT_NEAR(find(result->starts, "sp2: offset_mm").value, -3, 0.02);
}

TEST(Identify, OutliersDoNotPullARobustFit) {
  const Model truth = loaded("zhang2025");
  auto logs = two_logs(truth);
  std::mt19937_64 random(5);
  for (Log& log : logs) {
    for (double& y : log.displacement_mm) {
      if (std::uniform_real_distribution<double>(0, 1)(random) < 0.01) y += 8;
    }
  }
  IdentifyOptions options;
  const auto plain = identify(logs, truth, options);
  options.robust = true;
  const auto robust = identify(logs, truth, options);
  ASSERT_TRUE(plain && robust);
  EXPECT_GT(robust->huber_mm, 0);
  const double limit = truth.blocks[0].values[1] / (truth.blocks[0].values[2] + truth.blocks[0].values[3]);
  const auto error = [&](const Identification& r) {
    return std::abs(find(r.combinations, "hysteresis_limit_mm").value - limit);
  };
  EXPECT_LT(error(*robust), 0.25 * error(*plain));
}

TEST(Identify, ExponentIsChosenFromTheGivenValues) {
  Model truth = loaded("zhang2025");
  std::vector<double>& bw = truth.blocks[0].values;
  bw = {0.3, 0.2, 0.004, 0.006, 2};
  const auto logs = two_logs(truth, 20, 0.02);
  IdentifyOptions options;
  options.exponents = {1, 2};
  options.starts = 4;
  const auto result = identify(logs, loaded("zhang2025"), options);
  ASSERT_TRUE(result) << result.error();
  EXPECT_EQ(result->model.blocks[0].values[4], 2);
  ASSERT_EQ(result->exponent_rmse_mm.size(), 2U);
  EXPECT_NEAR(result->rmse_mm, 0.02, 0.05 * 0.02);
}

TEST(Identify, FitsTheRequestedNumberOfCreepBranches) {
  Model truth = loaded("zhang2025");
  auto& kv = truth.blocks[1].values;
  kv = {325.9, 18.0, 300.0, 6.0, 9.0, 3.0, 0.6};  // time constants of 16.7 s, 1.5 s and 0.2 s
  const auto logs = two_logs(truth);
  const auto three = identify(logs, base_model(logs, 3));
  const auto one = identify(logs, base_model(logs, 1));
  ASSERT_TRUE(three && one);
  EXPECT_NEAR(three->rmse_mm, 0.05, 0.02 * 0.05);
  EXPECT_GT(one->rmse_mm, 2 * three->rmse_mm);
  const std::vector<double> time_constants = branch_time_constants_s(three->model);
  ASSERT_EQ(time_constants.size(), 3U);
  EXPECT_NEAR(time_constants[1], 1.5, 0.1);
}

/// A model with a contact has no closed form, so the fit uses automatic differentiation. The fit must find
/// the contact.
TEST(Identify, ContactBlockIsFitted) {
  Model truth = loaded("zhang2025");
  model::BlockSpec contact = model::default_block(*model::find_block("contact"));
  truth = model::with_block(truth, contact);
  const std::size_t at = *model::position_of(truth, "contact");
  truth.blocks[at].values[0] = 18;
  const auto logs = two_logs(truth, 25);
  Model start = truth;
  start.blocks[at].values[0] = 14;
  IdentifyOptions options;
  options.starts = 2;
  const auto result = identify(logs, start, options);
  ASSERT_TRUE(result) << result.error();
  EXPECT_NEAR(result->rmse_mm, 0.05, 0.03 * 0.05);
  EXPECT_NEAR(result->model.blocks[at].values[0], 18, 0.2);
}

TEST(Identify, ResultIsIndependentOfTheThreadCount) {
  const auto logs = two_logs(loaded("bench_twin"), 25);
  IdentifyOptions options;
  options.starts = 6;
  options.threads = 1;
  const auto one = identify(logs, loaded("bench_twin"), options);
  options.threads = 3;
  const auto three = identify(logs, loaded("bench_twin"), options);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(model::flat_values(one->model), model::flat_values(three->model));
  EXPECT_EQ(one->multistart.rmse_mm, three->multistart.rmse_mm);
}

TEST(Identify, HeldOutReadingsAreNotFitted) {
  const Model truth = loaded("zhang2025");
  auto logs = two_logs(truth);
  for (Log& log : logs) {
    for (std::size_t i = log.size() * 3 / 4; i < log.size(); ++i) log.displacement_mm[i] += 4;
  }
  IdentifyOptions options;
  options.fit_share = 0.7;
  const auto result = identify(logs, truth, options);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->rmse_mm, 0.05, 0.02 * 0.05);
  ASSERT_EQ(result->held_out.size(), 2U);
  // The last 30 % of the log are held out. An error of 4 mm is added to the last 25 % of the log.
  EXPECT_NEAR(result->held_out[0].rmse_mm, 4 * std::sqrt(25.0 / 30), 0.1);
}

TEST(Identify, MeasuredPressureReplacesAValveModel) {
  const Model truth = loaded("bench_twin");
  auto logs = two_logs(truth);
  for (Log& log : logs) {
    log.pressure_kpa = pressures_behind(truth, log);
  }
  const auto command = identify(logs, base_model(logs, 2));
  IdentifyOptions options;
  options.record.drive = Drive::measured;
  const auto measured = identify(logs, base_model(logs, 2), options);
  ASSERT_TRUE(command && measured) << measured.error();
  EXPECT_NEAR(measured->rmse_mm, 0.05, 0.03 * 0.05);
  EXPECT_LT(find(measured->combinations, "beta_over_instantaneous_gain").value, 1);
  EXPECT_GT(find(command->combinations, "beta_over_instantaneous_gain").value, 1);
}

TEST(Identify, NoiseBlocksStayUnchanged) {
  Model start =
      model::with_block(loaded("zhang2025"), model::default_block(*model::find_block("sensor_noise")));
  const auto result = identify(two_logs(loaded("zhang2025")), start);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->model.blocks.size(), 3U);
  EXPECT_EQ(result->model.blocks[2], start.blocks[2]);
  EXPECT_TRUE(model::validate(result->model).empty());
}

TEST(Identify, ProfileIntervalsAgreeForInformativeData) {
  const Model truth = loaded("zhang2025");
  IdentifyOptions options;
  options.profile = true;
  options.starts = 2;
  const auto result = identify({simulated(truth, SignalName::tp1, 20, 0.05, 3, 0.6)}, truth, options);
  ASSERT_TRUE(result);
  for (const char* name : {"bouc_wen.eta_per_kpa", "kelvin_voigt.k2_kpa_per_mm"}) {
    const Estimate& e = find(result->parameters, name);
    ASSERT_TRUE(e.ci95 && e.profile95) << name;
    const double width = e.ci95->upper - e.ci95->lower;
    EXPECT_NEAR(e.profile95->upper - e.profile95->lower, width, 0.1 * width) << name;
  }
}

/// A short version of bench/sysid_coverage. Simulates data with random true parameters and with white and
/// correlated noise. Fits models to these data. Counts how often the interval contains the true value.
TEST(Identify, IntervalCoverageIsNear95Percent) {
  std::size_t inside = 0;
  std::size_t trials = 0;
  for (const char* name : {"zhang2025", "bench_twin"}) {
    for (const double correlation : {0.0, 0.9}) {
      for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Model truth = scattered(loaded(name), 0.05, 100 + seed);
        const std::vector<Log> logs{simulated(truth, SignalName::tp1, 40, 0.05, 200 + seed, correlation),
                                    simulated(truth, SignalName::sp2, 40, 0.05, 300 + seed, correlation)};
        IdentifyOptions options;
        options.starts = 1;
        const auto result = identify(logs, loaded(name), options);
        ASSERT_TRUE(result) << result.error();
        for (const Combination& c : combinations_of(truth)) {
          const Estimate& e = find(result->combinations, c.name);
          if (!e.identifiable) continue;
          ++trials;
          if (c.value(truth) >= e.ci95->lower && c.value(truth) <= e.ci95->upper) ++inside;
        }
      }
    }
  }
  const double share = static_cast<double>(inside) / static_cast<double>(trials);
  RecordProperty("coverage", std::to_string(share));
  EXPECT_GT(trials, 200U);
  EXPECT_GE(share, 0.90);
  EXPECT_LE(share, 0.995);
}

}  // namespace
}  // namespace softgrip::sysid::identify_test
