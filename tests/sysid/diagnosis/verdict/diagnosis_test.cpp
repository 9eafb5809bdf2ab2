#include "sysid/diagnosis/verdict/diagnosis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/periodic_disturbance.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/quantisation.h"
#include "model/blocks/slow_creep.h"
#include "model/blocks/transport_delay.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::diagnosis_test {
namespace {

constexpr double noise_mm = 0.03;

model::Model without_valve() {
  return model::only(loaded("bench_twin"),
                     [](const model::BlockInfo& info) { return info.station != model::Station::valve; });
}

// The first cause explains nearly the whole error. The small remaining error must not start a search for an
// alternative structure.
TEST(Diagnosis, SmallResidualStartsNoSearchForAnotherStructure) {
  const model::Model given = without_valve();
  const model::Model truth =
      model::with_block(given, model::block_of<model::TransportDelay>({{"delay_s", 0.4}}));
  std::vector<Log> logs;
  for (const model::SignalName signal : {model::SignalName::tp1, model::SignalName::sp2}) {
    logs.push_back(simulated(truth, signal, 25, noise_mm, 17));
    // Adds an error that oscillates with the displacement. No cause of the registry describes this error.
    for (double& y : logs.back().displacement_mm)
      y += 0.9 * noise_mm * std::sin(2 * std::numbers::pi * y / 5);
  }
  DiagnosisOptions options;
  std::mutex mutex;
  std::vector<std::string> said;
  options.progress = [&](const std::string& text) {
    const std::lock_guard lock(mutex);
    said.push_back(text);
  };
  const auto diagnosis = diagnose(logs, given, options);
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  ASSERT_TRUE(diagnosis->unexplained_error.present);
  EXPECT_GT(diagnosis->unexplained_error.excess_mm, 0.2 * noise_mm);
  ASSERT_EQ(diagnosis->causes.size(), 1U);
  EXPECT_EQ(diagnosis->causes.front().cause.id, "transport_delay");
  for (const std::string& text : said) {
    EXPECT_NE(text, "search for another model structure");
    EXPECT_NE(text, "search for stick-slip");
  }
}

/// Returns a model whose creep is `factor` times as slow.
model::Model with_slower_creep(model::Model given, double factor) {
  std::vector<double>& values = given.blocks[*model::position_of<model::KelvinVoigt>(given)].values;
  for (std::size_t damper = 2; damper < values.size(); damper += 2) values[damper] *= factor;
  return given;
}

// A rig of a different size is faster or slower. Only the unit of time differs, so the diagnosis must be the
// same.
TEST(Diagnosis, TheCauseIsNamedForEveryUnitOfTime) {
  constexpr double delay_s = 0.4;
  const model::Model given = loaded("zhang2025");
  const model::Model truth =
      model::with_block(given, model::block_of<model::TransportDelay>({{"delay_s", delay_s}}));
  const Log usual = simulated(truth, model::SignalName::tp1, 25, noise_mm, 17);
  for (const double factor : {1e-3, 1e3}) {
    SCOPED_TRACE(factor);
    Log log = usual;
    for (double& t : log.time_s) t *= factor;
    const auto diagnosis = diagnose({log}, with_slower_creep(given, factor), {});
    ASSERT_TRUE(diagnosis) << diagnosis.error();
    ASSERT_EQ(diagnosis->causes.size(), 1U);
    const NamedCause& named = diagnosis->causes.front();
    EXPECT_EQ(named.cause.id, "transport_delay");
    EXPECT_NEAR(named.parameters.front().value, factor * delay_s, 0.02 * factor * delay_s);
  }
}

// A disturbance, for example a pump, runs independently of the rig, so it begins each log with another phase.
TEST(Diagnosis, AnOscillationIsNamedAlthoughItsPhaseDiffersBetweenLogs) {
  constexpr double amplitude_mm = 0.1, frequency_hz = 3.3;
  const model::Model given = loaded("bench_twin");
  std::vector<Log> logs;
  for (const model::SignalName signal : {model::SignalName::tp1, model::SignalName::sp2}) {
    Log log = simulated(given, signal, 25, noise_mm, 17);
    const double phase = logs.empty() ? 0.3 : 0.3 + std::numbers::pi;
    for (std::size_t i = 0; i < log.size(); ++i)
      log.displacement_mm[i] +=
          amplitude_mm * std::sin(2 * std::numbers::pi * frequency_hz * log.time_s[i] + phase);
    logs.push_back(std::move(log));
  }
  const auto diagnosis = diagnose(logs, given, {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  ASSERT_EQ(diagnosis->causes.size(), 1U);
  const NamedCause& named = diagnosis->causes.front();
  EXPECT_EQ(named.cause.id, "periodic_disturbance");
  const auto value = [&](std::string_view name) {
    const auto parameter = std::find_if(named.parameters.begin(), named.parameters.end(),
                                        [&](const CauseParameter& p) { return p.name == name; });
    return parameter == named.parameters.end() ? std::nan("") : parameter->value;
  };
  EXPECT_NEAR(std::hypot(value("sine_mm"), value("cosine_mm")), amplitude_mm, 0.1 * amplitude_mm);
  EXPECT_NEAR(value("frequency_hz"), frequency_hz, 0.002);
}

// The extended model contains the phase that the oscillation had in the first log.
TEST(Diagnosis, AKnownOscillationIsNoErrorOfTheModelInAnotherLog) {
  model::Model given = loaded("bench_twin");
  std::vector<Log> logs;
  for (const double phase : {0.4, 2.1, 4.4}) {
    Log log = simulated(given, model::SignalName::tp1, 25, noise_mm, 17 + logs.size());
    for (std::size_t i = 0; i < log.size(); ++i)
      log.displacement_mm[i] += 0.2 * std::sin(2 * std::numbers::pi * 3.3 * log.time_s[i] + phase);
    logs.push_back(std::move(log));
  }
  given =
      model::with_block(std::move(given), model::block_of<model::PeriodicDisturbance>(
                                              {{"sine_mm", 0.2}, {"cosine_mm", 0}, {"frequency_hz", 3.3}}));
  const auto diagnosis = diagnose(logs, given, {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  EXPECT_LT(diagnosis->as_given_rmse_mm, 1.1 * noise_mm);
  EXPECT_TRUE(diagnosis->causes.empty());
}

// The log is simulated with the given model, so the model must explain the log. This must hold for every zero
// offset of the sensor and for a log that starts in motion.
TEST(Diagnosis, AsGivenEstimatesTheOffsetAndTheStart) {
  const model::Model truth = loaded("bench_twin");
  const Log log = simulated(truth, model::SignalName::tp1, 25, noise_mm, 5);
  const auto as_given_mm = [&](Log one, double shift_mm) {
    for (double& y : one.displacement_mm) y += shift_mm;
    const auto diagnosis = diagnose({std::move(one)}, truth, {});
    EXPECT_TRUE(diagnosis);
    return diagnosis ? diagnosis->as_given_rmse_mm : 0;
  };
  const double at_rest_mm = as_given_mm(log, 0);
  EXPECT_LT(at_rest_mm, 1.1 * noise_mm);
  EXPECT_NEAR(as_given_mm(log, 5), at_rest_mm, 1e-6);
  EXPECT_NEAR(as_given_mm(log, -410), at_rest_mm, 1e-6);
  const Log in_motion = slice(log, log.size() / 3, log.size());
  const double of_30_mm = 0.02 * 30;
  EXPECT_LT(as_given_mm(in_motion, 5), of_30_mm);
}

// The outliers are found before an alternative structure is fitted. The result with the alternative structure
// must still contain the outliers as a cause.
TEST(Diagnosis, OutliersStayNamedWithAnAlternativeStructure) {
  const model::Model given = without_valve();
  model::Model plays = model::without_block(given, model::block_type<model::BoucWen>());
  plays = model::with_block(std::move(plays), {model::block_type<model::PrandtlIshlinskii>(),
                                               {0, 0, 0, 0, 0, 0.1, 1, 0.1, 6, 0.02, 15, 0.08, 25, 0.06}});
  std::vector<Log> logs;
  std::size_t wrong = 0;
  for (const model::SignalName signal : {model::SignalName::tp1, model::SignalName::sp2}) {
    logs.push_back(simulated(plays, signal, 25, noise_mm, 17));
    std::vector<double>& y_mm = logs.back().displacement_mm;
    for (std::size_t i = 40; i < y_mm.size(); i += 97) y_mm[i] += wrong++ % 2 == 0 ? 1 : -1;
  }
  const auto diagnosis = diagnose(logs, given, {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  EXPECT_FALSE(diagnosis->base.empty());
  const auto names = [&](std::string_view id) {
    return std::any_of(diagnosis->causes.begin(), diagnosis->causes.end(),
                       [&](const NamedCause& cause) { return cause.cause.id == id; });
  };
  EXPECT_TRUE(names("hysteresis_shape"));
  EXPECT_TRUE(names("outliers"));
  EXPECT_NEAR(static_cast<double>(diagnosis->outliers.count), static_cast<double>(wrong), 2);
}

/// Returns two logs in which the reading of sample i is replaced by the reading of sample `sample(i)`.
std::vector<Log> read_at(const model::Model& truth, const std::function<std::size_t(std::size_t)>& sample) {
  std::vector<Log> logs;
  for (const model::SignalName signal : {model::SignalName::tp1, model::SignalName::sp2}) {
    Log log = simulated(truth, signal, 50, noise_mm, 23);
    const std::vector<double> truth_mm = log.displacement_mm;
    for (std::size_t i = 0; i < log.size(); ++i)
      log.displacement_mm[i] = truth_mm[std::min(sample(i), log.size() - 1)];
    logs.push_back(std::move(log));
  }
  return logs;
}

TEST(Diagnosis, ReadingSlowerThanTheLogIsNamedSampling) {
  const model::Model truth = without_valve();
  const auto diagnosis = diagnose(read_at(truth, [](std::size_t i) { return i - i % 9; }), truth, {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  EXPECT_EQ(diagnosis->verdict, Verdict::cause_found);
  ASSERT_EQ(diagnosis->causes.size(), 1U);
  EXPECT_EQ(diagnosis->causes[0].cause.id, "sampling");
  EXPECT_NEAR(diagnosis->causes[0].parameters.at(0).value, 9 * 0.02, 1e-3);
}

/// Rounds the readings of two logs to multiples of 0.4 mm.
std::vector<Log> coarse_logs(const model::Model& truth) {
  std::vector<Log> logs = read_at(truth, [](std::size_t i) { return i; });
  for (Log& log : logs) {
    for (double& y : log.displacement_mm) y = 0.4 * std::round(y / 0.4);
  }
  return logs;
}

TEST(Diagnosis, CoarseResolutionIsNamedSampling) {
  const model::Model truth = without_valve();
  const auto diagnosis = diagnose(coarse_logs(truth), truth, {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  EXPECT_EQ(diagnosis->verdict, Verdict::cause_found);
  ASSERT_EQ(diagnosis->causes.size(), 1U);
  EXPECT_EQ(diagnosis->causes[0].cause.id, "sampling");
  EXPECT_EQ(diagnosis->causes[0].parameters.at(0).name, "step_mm");
  EXPECT_NEAR(diagnosis->causes[0].parameters[0].value, 0.4, 1e-9);
  EXPECT_NEAR(diagnosis->noise_mm, std::hypot(noise_mm, 0.4 / std::sqrt(12)), 0.01);
}

TEST(Diagnosis, AKnownResolutionIsNoErrorOfTheModel) {
  const model::Model truth =
      model::with_block(without_valve(), {model::block_type<model::Quantisation>(), {0.4}});
  const auto diagnosis = diagnose(coarse_logs(truth), truth, {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  EXPECT_TRUE(diagnosis->causes.empty());
  EXPECT_TRUE(diagnosis->verdict == Verdict::adequate || diagnosis->verdict == Verdict::recalibrate)
      << name_of(diagnosis->verdict);
}

// The block of this cause extrapolates the motion linearly. A lead of 0.2 s is too long for this block, so
// only the shift of the drive explains the readings.
TEST(Diagnosis, ReadingAheadOfTheCommandIsAClockOffset) {
  const model::Model truth = without_valve();
  const auto diagnosis = diagnose(read_at(truth, [](std::size_t i) { return i + 10; }), truth, {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  EXPECT_EQ(diagnosis->verdict, Verdict::cause_found);
  ASSERT_EQ(diagnosis->causes.size(), 1U);
  const NamedCause& named = diagnosis->causes[0];
  EXPECT_EQ(named.cause.id, "clock_offset");
  EXPECT_NEAR(named.parameters.at(0).value, 10 * 0.02, 0.004);
  EXPECT_LE(named.parameters[0].ci95.lower, 10 * 0.02);
  EXPECT_GE(named.parameters[0].ci95.upper, 10 * 0.02);
  EXPECT_GT(named.gain_percent.lower, 0);
  EXPECT_LT(diagnosis->extended_rmse_mm, 1.05 * noise_mm);
  EXPECT_GT(diagnosis->recalibrated_rmse_mm, 1.2 * diagnosis->extended_rmse_mm);
}

/// Returns a log whose finger was under pressure before the log begins and is still moving.
Log begun_unsettled(const model::Model& truth, model::SignalName signal, double pulse_kpa,
                    std::uint64_t seed) {
  constexpr double rate_hz = 25;
  constexpr std::size_t pressed = 250, rested = 75;
  Log log = simulated(truth, signal, rate_hz, noise_mm, seed);
  const std::vector<double> command_kpa = log.pressure_command_kpa;
  log.pressure_command_kpa.assign(pressed, pulse_kpa);
  log.pressure_command_kpa.resize(pressed + rested, 0);
  log.pressure_command_kpa.insert(log.pressure_command_kpa.end(), command_kpa.begin(), command_kpa.end());
  log.displacement_mm.assign(log.pressure_command_kpa.size(), 0);
  log.time_s.clear();
  for (std::size_t i = 0; i < log.displacement_mm.size(); ++i)
    log.time_s.push_back(static_cast<double>(i) / rate_hz);
  const Record record = make_records({log}, {.start = Start::rest}).front();
  log.displacement_mm = predict(truth, record, rest_starts(truth, {record}).front());
  for (std::size_t i = 0; i < log.displacement_mm.size(); ++i)
    log.displacement_mm[i] += noise_mm * normal_at(seed, i);
  return slice(log, pressed + rested, log.size());
}

/// When a log starts, the finger may still creep although the pressure is 0. This creep must not be named as
/// a cause.
TEST(Diagnosis, AStartBeforeTheFingerHasSettledIsNoCause) {
  const model::Model truth = without_valve();
  const std::vector<Log> logs{begun_unsettled(truth, model::SignalName::tp1, 45, 3),
                              begun_unsettled(truth, model::SignalName::sp2, 20, 4),
                              begun_unsettled(truth, model::SignalName::tp2, 35, 5)};
  const auto diagnosis = diagnose(logs, truth, {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  EXPECT_TRUE(diagnosis->causes.empty()) << diagnosis->causes.front().cause.id;
  EXPECT_FALSE(diagnosis->unexplained_recalibrated.present) << diagnosis->unexplained_recalibrated.excess_mm;
}

/// Returns one recording as several logs. Each log contains one signal, and the finger does not settle
/// between the logs.
std::vector<Log> parts_of_one_recording(const model::Model& truth,
                                        const std::vector<model::SignalName>& signals, std::uint64_t seed) {
  constexpr double rate_hz = 25;
  constexpr std::size_t rest = 200;
  Log all;
  std::vector<std::size_t> ends;
  for (const model::SignalName signal : signals) {
    const std::vector<double> command_kpa = simulated(truth, signal, rate_hz, 0, 1).pressure_command_kpa;
    all.pressure_command_kpa.insert(all.pressure_command_kpa.end(), command_kpa.begin(), command_kpa.end());
    all.pressure_command_kpa.resize(all.pressure_command_kpa.size() + rest, 0);
    ends.push_back(all.pressure_command_kpa.size());
  }
  for (std::size_t i = 0; i < ends.back(); ++i) all.time_s.push_back(static_cast<double>(i) / rate_hz);
  all.displacement_mm.assign(all.size(), 0);
  const Record record = make_records({all}, {.start = Start::rest}).front();
  all.displacement_mm = predict(truth, record, rest_starts(truth, {record}).front());
  for (std::size_t i = 0; i < all.size(); ++i) all.displacement_mm[i] += noise_mm * normal_at(seed, i);
  std::vector<Log> parts;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    parts.push_back(slice(all, k == 0 ? 0 : ends[k - 1], ends[k]));
    parts.back().name = "part " + std::to_string(k + 1);
  }
  return parts;
}

/// Slow creep continues in the next log. A drift of the sensor can imitate this creep only approximately.
TEST(Diagnosis, SlowCreepThatContinuesFromLogToLogIsNoDriftOfTheSensor) {
  const model::Model truth =
      model::with_block(without_valve(), {model::block_type<model::SlowCreep>(), {0.12, 150}});
  using enum model::SignalName;
  const auto diagnosis = diagnose(parts_of_one_recording(truth, {hold, steps, hold}, 5), without_valve(), {});
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  ASSERT_EQ(diagnosis->causes.size(), 1U) << verdict_sentence(*diagnosis);
  EXPECT_EQ(diagnosis->causes[0].cause.id, "slow_creep");
  EXPECT_NEAR(diagnosis->causes[0].parameters.at(1).value, 150, 50);
  EXPECT_LT(diagnosis->extended_rmse_mm, 1.05 * noise_mm);
}

Diagnosis errors_mm(double as_given, double recalibrated, double extended, double noise) {
  Diagnosis d;
  d.as_given_rmse_mm = as_given;
  d.recalibrated_rmse_mm = recalibrated;
  d.extended_rmse_mm = extended;
  d.noise_mm = noise;
  return d;
}

NamedCause worth_mm2(double gain) {
  NamedCause named;
  named.gain_mm2.value = gain;
  return named;
}

TEST(Budget, IsInSquareMillimetres) {
  const Budget budget = budget_of(errors_mm(0.5, 0.3, 0.1, 0.05));
  EXPECT_DOUBLE_EQ(budget.as_given, 0.25);
  EXPECT_DOUBLE_EQ(budget.excess(), 0.09 - 0.0025);
  EXPECT_DOUBLE_EQ(budget.left(), 0.01 - 0.0025);
}

TEST(Budget, ErrorBelowTheNoiseCountsAsZero) {
  const Budget budget = budget_of(errors_mm(0.05, 0.04, 0.03, 0.05));
  EXPECT_EQ(budget.excess(), 0);
  EXPECT_EQ(budget.left(), 0);
  EXPECT_EQ(budget.share_percent(worth_mm2(0.01)), 0)
      << "if the mean square error is 0, every share must be 0";
}

TEST(Budget, ShareIsLimitedToTheRangeFrom0To100Percent) {
  const Budget budget = budget_of(errors_mm(0.5, 0.3, 0.1, 0));
  EXPECT_DOUBLE_EQ(budget.share_percent(worth_mm2(0.045)), 50);
  EXPECT_EQ(budget.share_percent(worth_mm2(1)), 100);
  EXPECT_EQ(budget.share_percent(worth_mm2(-1)), 0) << "the held-out error is smaller without the cause";
}

}  // namespace
}  // namespace softgrip::sysid::diagnosis_test
