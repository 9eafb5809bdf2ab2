#include "sysid/diagnosis/verdict/data_warnings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "sysid/logs/resampled_record.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::data_warnings_test {
namespace {

std::vector<std::vector<double>> no_responses() {
  return {};
}

NamedCause named(std::string_view id) {
  NamedCause cause;
  cause.cause = *find_cause(id);
  return cause;
}

Diagnosis with(std::initializer_list<std::string_view> ids) {
  Diagnosis d;
  d.verdict = Verdict::cause_found;
  for (const std::string_view id : ids) d.causes.push_back(named(id));
  return d;
}

std::vector<std::string> ids(const std::vector<NamedCause>& causes) {
  std::vector<std::string> list;
  for (const NamedCause& one : causes) list.emplace_back(one.cause.id);
  return list;
}

/// Returns one log whose command oscillates around 20 kPa.
/// @param rest_s  time without pressure at the start of the log [s].
std::vector<Log> planned(double rest_s) {
  Log log;
  log.name = "planned";
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.02 * i;
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(t < rest_s ? 0 : 20 + 10 * std::sin(t - rest_s));
    log.displacement_mm.push_back(0.2 * log.pressure_command_kpa.back());
  }
  return {log};
}

/// Returns one log of a control loop in which a valve keeps a flow constant.
/// @param band  change of the command to which the valve does not respond.
/// @param wave  amplitude of a disturbance of the flow. Without it, a constant load lies between two
/// positions of the valve, so a sticking valve jumps again and again.
std::vector<Log> loop(double band, double wave) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 0.01);
  Log log;
  log.name = "loop";
  double stem = 0.3, flow = 0, sum = 0;
  for (int i = 0; i < 1500; ++i) {
    const double load = wave > 0 ? wave * std::sin(2 * std::numbers::pi * i / 60.0) : 0.13;
    const double reading = flow + load + noise(random);
    sum += 0.03 * reading;
    const double command = -(wave > 0 ? 0.4 : 0.05) * reading - sum;
    if (std::abs(command - stem) > band) stem = command;
    flow += 0.5 * (stem - flow);
    log.time_s.push_back(i);
    log.pressure_command_kpa.push_back(10 + command);
    log.displacement_mm.push_back(reading);
  }
  return {log};
}

TEST(UntestedCauses, ADriftNeedsARestWithoutPressure) {
  Diagnosis d = with({"sensor_drift", "transport_delay"});
  correct_by_logs(d, planned(0), no_responses);
  EXPECT_EQ(ids(d.causes), std::vector<std::string>{"transport_delay"});
  EXPECT_EQ(ids(d.partial), std::vector<std::string>{"sensor_drift"});
  EXPECT_EQ(d.verdict, Verdict::partly_explained);
  EXPECT_NE(d.not_tested.at("sensor_drift").find("rest"), std::string::npos);
  Diagnosis alone = with({"sensor_drift"});
  correct_by_logs(alone, planned(2.9), no_responses);
  EXPECT_TRUE(alone.causes.empty());
  EXPECT_EQ(alone.verdict, Verdict::unexplained);
  Diagnosis shown = with({"sensor_drift"});
  correct_by_logs(shown, planned(3.1), no_responses);
  EXPECT_EQ(ids(shown.causes), std::vector<std::string>{"sensor_drift"});
  EXPECT_EQ(shown.verdict, Verdict::cause_found);
  EXPECT_TRUE(shown.not_tested.empty());
}

TEST(UntestedCauses, ClosedLoopNamesAStickingValveWithItsBand) {
  Diagnosis d = with({"rate_dependent_hysteresis"});
  correct_by_logs(d, loop(0.3, 0), no_responses);
  EXPECT_EQ(ids(d.causes), std::vector<std::string>{"valve_deadband"});
  EXPECT_EQ(ids(d.partial), std::vector<std::string>{"rate_dependent_hysteresis"});
  ASSERT_EQ(d.warnings.size(), 2U);
  EXPECT_NE(d.warnings.back().find("dead band of about 0."), std::string::npos) << d.warnings.back();
  EXPECT_EQ(d.verdict, Verdict::partly_explained);
  ASSERT_TRUE(d.loop_bands_kpa);
  ASSERT_EQ(d.loop_bands_kpa->size(), 1U);
  const NamedCause& valve = d.causes.front();
  ASSERT_EQ(valve.parameters.size(), 1U);
  EXPECT_EQ(valve.parameters.front().name, "band_kpa");
  EXPECT_EQ(valve.parameters.front().value, d.loop_bands_kpa->front());
  EXPECT_FALSE(valve.parameters.front().has_interval);
  EXPECT_TRUE(valve.only_in_loop);
  for (const double value : {valve.gain_percent.value, valve.gain_mm2.value, valve.inclusion})
    EXPECT_TRUE(std::isnan(value)) << value;
}

/// If the extended model contains the valve, the error reduction that the search has measured is kept.
TEST(UntestedCauses, ValveOfTheExtendedModelKeepsItsResult) {
  for (const bool in_extended_model : {true, false}) {
    Diagnosis d = with({"valve_deadband", "rate_dependent_hysteresis"});
    d.causes.front().gain_percent.value = 31;
    if (in_extended_model)
      d.extended_model =
          model::with_block({}, find_cause("valve_deadband")->forms.front().starts(Scales{})[0]);
    correct_by_logs(d, loop(0.3, 0), no_responses);
    EXPECT_EQ(ids(d.causes), std::vector<std::string>{"valve_deadband"});
    EXPECT_EQ(ids(d.partial), std::vector<std::string>{"rate_dependent_hysteresis"});
    EXPECT_EQ(d.causes.front().only_in_loop, !in_extended_model);
    EXPECT_EQ(d.causes.front().gain_percent.value == 31, in_extended_model);
  }
}

TEST(UntestedCauses, DisturbedClosedLoopKeepsTheNamedCauses) {
  Diagnosis d = with({"rate_dependent_hysteresis"});
  correct_by_logs(d, loop(0, 1), no_responses);
  EXPECT_EQ(ids(d.causes), std::vector<std::string>{"rate_dependent_hysteresis"});
  ASSERT_EQ(d.warnings.size(), 1U);
  EXPECT_NE(d.warnings.front().find("closed loop"), std::string::npos);
}

/// If command and reading rise together, a response with hysteresis explains the readings as well as a
/// sticking valve does.
TEST(UntestedCauses, HysteresisOfTheModelKeepsTheNamedCauses) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.01);
  Log log;
  std::vector<double> response;
  double left = 0, moved = 0, sum = 0;
  for (int i = 0; i < 1500; ++i) {
    const double setpoint = 0.3 * (i / 80 % 3), error = setpoint - moved + noise(random);
    sum += 0.05 * error;
    log.time_s.push_back(i);
    log.pressure_command_kpa.push_back(10 + 0.1 * error + sum);
    log.displacement_mm.push_back(setpoint - error);
    left = std::clamp(left, 0.1 * error + sum - 0.15, 0.1 * error + sum + 0.15);
    moved += 0.5 * (left - moved);
    response.push_back(moved);
  }
  Diagnosis d = with({"rate_dependent_hysteresis"}), without = d;
  correct_by_logs(d, {log}, [&] { return std::vector<std::vector<double>>{response}; });
  EXPECT_EQ(ids(d.causes), std::vector<std::string>{"rate_dependent_hysteresis"});
  correct_by_logs(without, {log}, no_responses);
  EXPECT_EQ(ids(without.causes), std::vector<std::string>{"valve_deadband"});
}

TEST(UntestedCauses, OnePlannedLogRulesOutAClosedLoop) {
  Diagnosis d = with({"rate_dependent_hysteresis"});
  std::vector<Log> logs = loop(0.3, 0);
  logs.push_back(planned(5).front());
  correct_by_logs(d, logs, no_responses);
  EXPECT_EQ(ids(d.causes), std::vector<std::string>{"rate_dependent_hysteresis"});
  EXPECT_TRUE(d.warnings.empty());
}

std::vector<Record> records_at(double rate_hz, std::size_t count) {
  const Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, rate_hz, 0.02, 7);
  return make_records(std::vector<Log>(count, log), {});
}

TEST(DenseLogs, DenseReadingsAreAveragedWithAWarning) {
  std::vector<Record> records = records_at(2000, 1);
  ASSERT_GT(records.front().readings, enough_readings);
  const double length_s = records.front().length_s();
  std::vector<std::string> warnings;
  EXPECT_TRUE(average_dense(records, warnings));
  EXPECT_NEAR(records.front().mean_interval_s(), averaged_interval_in_units, 1e-9);
  EXPECT_NEAR(records.front().length_s(), length_s, averaged_interval_in_units);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings.front().find("2000 samples per second"), std::string::npos) << warnings.front();
}

TEST(DenseLogs, AFastRigNeedsItsReadings) {
  Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, 2000, 0.02, 7);
  for (double& t : log.time_s) t /= 1000;
  std::vector<Record> records = make_records({log}, {});
  ASSERT_GT(records.front().readings, enough_readings);
  std::vector<std::string> warnings;
  (void)average_dense(records, warnings);
  EXPECT_GT(records.front().readings, enough_readings / 2) << "5 ms would leave 16 readings";
}

TEST(DenseLogs, LongAndShortLogsAreNotAveraged) {
  std::vector<std::string> warnings;
  std::vector<Record> long_campaign = records_at(100, 12);
  EXPECT_FALSE(average_dense(long_campaign, warnings));
  Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, 500, 0.02, 7);
  for (auto* column : {&log.time_s, &log.pressure_command_kpa, &log.displacement_mm})
    column->resize(enough_readings);
  std::vector<Record> short_one = make_records({log}, {});
  ASSERT_EQ(short_one.front().readings, enough_readings);
  EXPECT_FALSE(average_dense(short_one, warnings));
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace softgrip::sysid::data_warnings_test
