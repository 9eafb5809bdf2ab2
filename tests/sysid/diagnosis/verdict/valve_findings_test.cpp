#include "sysid/diagnosis/verdict/valve_findings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::valve_findings_test {
namespace {

constexpr double noise_kpa = 0.05, noise_mm = 0.04, sample_s = 0.01;

/// A valve that this test simulates with Euler steps of 50 us. The simulation shares no blocks with model/.
struct OwnValve {
  double delay_s = 0.05;
  double band_kpa = 0;
  double filling_s = 0.06;
  double venting_s = 0.06;
  double second_s = 0;  ///< time constant of a second lag in series; 0: no second lag
  double limit_kpa = 1e9;
  double coupling = 0;
  double leak = 0;   ///< conductance of the leak, divided by the conductance of the line
  double scale = 1;  ///< scale factor of the pressure sensor
};

/// Returns the flow of ISO 6358-1 at reference conditions, divided by the conductance, for a critical
/// pressure ratio of 0.3. The arguments are absolute pressures [kPa].
double flow(double from_kpa, double to_kpa) {
  const double ratio = std::max(to_kpa / from_kpa, 0.3);
  return from_kpa * std::sqrt(1 - std::pow((ratio - 0.3) / 0.7, 2));
}

/// Returns the pressure behind a line [kPa] for which the inflow equals the flow through the leak. The
/// pressure is found by bisection.
double behind_leak(double kpa, double leak) {
  if (!(leak > 0) || !(kpa > 0)) return kpa;
  constexpr double open_kpa = 101.325;
  double low = 0, high = kpa;
  for (int i = 0; i < 40; ++i) {
    const double p = 0.5 * (low + high);
    (flow(kpa + open_kpa, p + open_kpa) > leak * flow(p + open_kpa, open_kpa) ? low : high) = p;
  }
  return low;
}

double command_kpa(double t, int log) {
  const double sine =
      30 + 25 * std::sin(2 * std::numbers::pi * (log == 0 ? 0.05 : 0.13) * t - std::numbers::pi / 2);
  return log == 2 ? 10 * std::floor(std::fmod(t, 50) / 10) + 5 : sine;
}

double supply_kpa(double t) {
  return 180 - 30 * std::fmod(t, 40) / 40;
}

Log own_log(const OwnValve& valve, int number, std::uint32_t seed) {
  constexpr int parts = 200;
  constexpr double h = sample_s / parts;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Log log;
  log.name = "log_" + std::to_string(number);
  double stuck = command_kpa(0, number), first = stuck, second = stuck;
  std::deque<double> late(static_cast<std::size_t>(valve.delay_s / h), stuck);
  for (int i = 0; i <= 4000; ++i) {
    const double t = sample_s * i;
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(command_kpa(t, number));
    log.supply_kpa.push_back(supply_kpa(t));
    const double sag = 1 - valve.coupling * (1 - supply_kpa(t) / 180);
    const double p =
        behind_leak(std::min((valve.second_s > 0 ? second : first) * sag, valve.limit_kpa), valve.leak);
    log.pressure_kpa.push_back(valve.scale * p + noise_kpa * normal(random));
    log.displacement_mm.push_back(0.5 * p + noise_mm * normal(random));
    for (int k = 0; k < parts; ++k) {
      // The command is linear between two samples. The diagnosis makes the same assumption for logs.
      const double share = static_cast<double>(k) / parts;
      late.push_back((1 - share) * command_kpa(t, number) + share * command_kpa(sample_s * (i + 1), number));
      const double u = late.front();
      late.pop_front();
      stuck = std::clamp(stuck, u - valve.band_kpa / 2, u + valve.band_kpa / 2);
      first += h * (stuck - first) / (stuck > first ? valve.filling_s : valve.venting_s);
      if (valve.second_s > 0) second += h * (first - second) / valve.second_s;
    }
  }
  return log;
}

std::vector<Log> own_logs(const OwnValve& valve, std::uint32_t seed = 1) {
  return {own_log(valve, 0, seed), own_log(valve, 1, seed + 1), own_log(valve, 2, seed + 2)};
}

model::Model without_a_valve() {
  return model::only(loaded("bench_twin"),
                     [](const model::BlockInfo& info) { return info.station != model::Station::valve; });
}

ValveFindings found_in(const std::vector<Log>& logs, const model::Model& given) {
  auto found = find_in_valve(logs, {given, false, noise_mm, 1});
  EXPECT_TRUE(found);
  return found.value_or(ValveFindings{});
}

/// Returns a parameter of a named cause. Returns nullptr if the cause is not named.
const CauseParameter* find(const ValveFindings& found, std::string_view cause, std::string_view parameter) {
  for (const NamedCause& named : found.named) {
    if (named.cause.id != cause) continue;
    for (const CauseParameter& p : named.parameters) {
      if (p.name == parameter) return &p;
    }
  }
  return nullptr;
}

void expect_holds(const ValveFindings& found, std::string_view cause, std::string_view parameter,
                  double truth) {
  const CauseParameter* p = find(found, cause, parameter);
  ASSERT_NE(p, nullptr) << cause << " is not named";
  ASSERT_TRUE(p->has_interval);
  // A 95 % interval does not contain the true value in 1 of 20 cases, which is too often for a test. An
  // interval of 1.5 times the width does not contain it in 1 of 300 cases.
  const double half = (p->ci95.upper - p->ci95.lower) / 2;
  EXPECT_NEAR(p->value, truth, 1.5 * half) << parameter;
  EXPECT_LT(half, 0.1 * truth) << parameter;
}

TEST(FindInValve, NamesOnlyDelayAndLagWithCorrectIntervals) {
  const ValveFindings found = found_in(own_logs({}), without_a_valve());
  EXPECT_EQ(found.named.size(), 2U);
  expect_holds(found, "transport_delay", "delay_s", 0.05);
  expect_holds(found, "valve_lag", "time_constant_s", 0.06);
  EXPECT_NEAR(found.heldout_rmse_kpa, noise_kpa, 0.02 * noise_kpa + 0.002);
}

TEST(FindInValve, NamesNoCauseThatTheGivenModelContains) {
  model::Model given = model::with_block(without_a_valve(), {model::block_type<model::ValveLag>(), {0.3}});
  given = model::with_block(std::move(given), {model::block_type<model::TransportDelay>(), {0.1}});
  EXPECT_TRUE(found_in(own_logs({}), given).named.empty());
}

TEST(FindInValve, NamesADeadBandASupplySagAndAPressureLimit) {
  OwnValve ignores, sags, stops;
  ignores.band_kpa = 1.5;
  sags.coupling = 0.3;
  stops.limit_kpa = 52;
  expect_holds(found_in(own_logs(ignores, 11), without_a_valve()), "valve_deadband", "band_kpa", 1.5);
  expect_holds(found_in(own_logs(sags, 21), without_a_valve()), "supply_sag", "coupling", 0.3);
  expect_holds(found_in(own_logs(stops, 31), without_a_valve()), "pressure_saturation", "limit_kpa", 52);
}

TEST(FindInValve, SecondLagIsAnAlternativeToADeadTime) {
  const auto alternatives_of_delay = [](const OwnValve& valve) -> std::optional<std::vector<std::string>> {
    for (const NamedCause& named : found_in(own_logs(valve, 111), without_a_valve()).named) {
      if (named.cause.id != "transport_delay") continue;
      std::vector<std::string> ids;
      for (const Cause& alternative : named.alternatives) ids.emplace_back(alternative.id);
      return ids;
    }
    return std::nullopt;
  };
  EXPECT_EQ(alternatives_of_delay({.delay_s = 0.005, .second_s = 0.1}),
            std::vector<std::string>{"valve_lag"});
  EXPECT_EQ(alternatives_of_delay({}), std::vector<std::string>{});
}

bool names(const ValveFindings& found, std::string_view cause) {
  return std::any_of(found.named.begin(), found.named.end(),
                     [&](const NamedCause& named) { return named.cause.id == cause; });
}

TEST(FindInValve, NamesALeakWithPressureScaleAsAlternative) {
  const ValveFindings found = found_in(own_logs({.leak = 0.2}, 91), without_a_valve());
  // The true value of `share` is 0.2 squared. The tolerance is necessary because the simulation and the model
  // have different critical pressure ratios.
  const CauseParameter* const share = find(found, "leak", "share");
  ASSERT_NE(share, nullptr);
  EXPECT_NEAR(share->value, 0.04, 0.008);
  EXPECT_NEAR(found.heldout_rmse_kpa, noise_kpa, 0.5 * noise_kpa);
  for (const NamedCause& named : found.named) {
    EXPECT_EQ(named.alternatives.size(), named.cause.id == "leak" ? 1U : 0U) << named.cause.id;
    if (named.cause.id == "leak") {
      EXPECT_EQ(named.alternatives.front().id, "pressure_scale");
      EXPECT_GT(named.gain_kpa2->lower, 0);
    }
  }
  const double missing_kpa = 55 - behind_leak(55, 0.2);
  EXPECT_NE(found.advice.find(significant(missing_kpa, 2) + " kPa of the command"), std::string::npos)
      << found.advice << " " << missing_kpa;
  EXPECT_TRUE(names(found_in(own_logs({.scale = 0.96}, 94), without_a_valve()), "leak"));
}

TEST(FindInValve, NamesNoLeakForOtherEffectsOrSmallScaleErrors) {
  for (const OwnValve& valve :
       {OwnValve{.scale = 0.99}, OwnValve{.scale = 1.04}, OwnValve{.limit_kpa = 40},
        OwnValve{.coupling = 0.5}, OwnValve{.band_kpa = 2}, OwnValve{.second_s = 0.3}}) {
    const ValveFindings found = found_in(own_logs(valve, 101), without_a_valve());
    EXPECT_FALSE(names(found, "leak")) << valve.scale << " " << valve.limit_kpa << " " << valve.coupling;
    EXPECT_TRUE(found.advice.empty()) << found.advice;
  }
}

TEST(FindInValve, SeparatesFillingFromVentingTimeConstants) {
  OwnValve valve;
  valve.filling_s = 0.05;
  valve.venting_s = 0.12;
  const ValveFindings found = found_in(own_logs(valve, 41), without_a_valve());
  expect_holds(found, "valve_lag", "filling_time_constant_s", 0.05);
  expect_holds(found, "valve_lag", "venting_time_constant_s", 0.12);
}

TEST(FindInValve, AValveOfSecondOrderHasNoDeadBandNoLimitAndNoSag) {
  OwnValve valve;
  valve.second_s = 0.05;
  const ValveFindings found = found_in(own_logs(valve, 51), without_a_valve());
  for (const char* id : {"valve_deadband", "pressure_saturation", "supply_sag"}) {
    EXPECT_FALSE(names(found, id)) << id;
  }
}

TEST(FindInValve, NamesNothingIfTheValveModelFitsPoorly) {
  OwnValve valve;
  valve.limit_kpa = 35;
  std::vector<Log> logs = own_logs(valve, 81);
  // Adds a pressure oscillation that the valve model cannot describe. A second controller in the regulator
  // could cause such an oscillation.
  for (Log& log : logs) {
    for (std::size_t i = 0; i < log.size(); ++i) log.pressure_kpa[i] += 6 * std::sin(1.7 * log.time_s[i]);
  }
  const ValveFindings found = found_in(logs, without_a_valve());
  EXPECT_TRUE(found.stage.is_far_off()) << found.stage.rmse_percent;
  EXPECT_TRUE(found.named.empty());
}

TEST(FindInValve, EffectBelowTheDisplacementNoiseIsNotNamed) {
  OwnValve valve;
  valve.band_kpa = 0.4;
  std::vector<Log> logs = own_logs(valve, 61);
  ASSERT_NE(find(found_in(logs, without_a_valve()), "valve_deadband", "band_kpa"), nullptr);
  for (Log& log : logs) {
    for (double& mm : log.displacement_mm) mm *= 0.1;
  }
  EXPECT_EQ(find(found_in(logs, without_a_valve()), "valve_deadband", "band_kpa"), nullptr);
}

TEST(FindInValve, NeedsTheMeasuredPressureOfEveryLog) {
  const model::Model given = without_a_valve();
  std::vector<Log> logs = own_logs({});
  logs[1].pressure_kpa.clear();
  EXPECT_FALSE(find_in_valve(logs, {given, false, noise_mm, 1}));
  logs = own_logs({});
  for (Log& log : logs) std::fill(log.pressure_kpa.begin(), log.pressure_kpa.end(), 7);
  EXPECT_FALSE(find_in_valve(logs, {given, false, noise_mm, 1})) << "the measured pressure is constant";
}

/// Returns the displacement that the model predicts for the measured pressure of a log.
std::vector<double> displacement_mm(const model::Model& finger, Log log) {
  std::fill(log.displacement_mm.begin(), log.displacement_mm.end(), 0.0);
  RecordOptions options;
  options.drive = Drive::measured;
  const std::vector<Record> records = make_records({log}, options);
  std::vector<double> moved =
      evaluate_structure(records, {}, {finger, rest_starts(finger, records)}).residual_mm.front();
  for (double& mm : moved) mm = -mm;
  return moved;
}

TEST(Diagnose, ValveDeadBandIsNamedForAnAdequateFingerModel) {
  const model::Model finger = without_a_valve();
  std::vector<Log> logs = own_logs({.band_kpa = 2}, 71);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (Log& log : logs) {
    log.supply_kpa.clear();
    log.displacement_mm = displacement_mm(finger, log);
    for (double& mm : log.displacement_mm) mm += noise_mm * normal(random);
  }
  DiagnosisOptions options;
  options.record.drive = Drive::measured;
  const auto diagnosis = diagnose(logs, finger, options);
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  EXPECT_TRUE(diagnosis->causes.empty()) << verdict_sentence(*diagnosis);
  EXPECT_EQ(diagnosis->verdict, Verdict::adequate);
  EXPECT_EQ(whole_verdict(*diagnosis), Verdict::cause_found);
  ASSERT_TRUE(diagnosis->in_valve);
  EXPECT_NE(find(*diagnosis->in_valve, "valve_deadband", "band_kpa"), nullptr);
  EXPECT_NE(verdict_sentence(*diagnosis).find("valve dead band"), std::string::npos);
  // The daemon commands the valve, so the models for the daemon must contain the valve. This also holds if
  // the input of the diagnosis was the measured pressure.
  for (const model::Model& model : {diagnosis->recalibrated_model, diagnosis->extended_model}) {
    EXPECT_TRUE(model::position_of<model::TransportDelay>(model)) << model.name;
    EXPECT_TRUE(model::position_of<model::ValveDeadband>(model)) << model.name;
  }
}

}  // namespace
}  // namespace softgrip::sysid::valve_findings_test
