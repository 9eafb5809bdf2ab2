#include "sysid/changes/regulator.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sysid/logs/resampled_record.h"
#include "tests/blind/textbook/valve.h"
#include "tests/sysid/changes/regulator_records.h"

namespace softgrip::sysid::regulator_test {
namespace {

using test::record_of;
using test::rms;

/// Returns a record whose command steps up after 0.5 s.
Record step_record() {
  std::vector<double> command(600, 50.0);
  std::fill(command.begin(), command.begin() + 50, 0.0);
  return record_of(command, 0.01);
}

TEST(Regulator, IntegralTermRemovesTheErrorOfTheOverlap) {
  const Record record = step_record();
  Regulator overlapping{.play_kpa = 0.1, .dead_kpa = 3, .integral_per_s = 2};
  const std::vector<double> p = regulated(overlapping, record, record.drive_kpa);
  EXPECT_EQ(p[49], 0);
  EXPECT_NEAR(p.back(), 50, 0.3);
  overlapping.integral_per_s = 0.001;
  EXPECT_NEAR(regulated(overlapping, record, record.drive_kpa).back(), 47, 0.3);
}

TEST(Regulator, ChokedFillingRateIsProportionalToSupplyPressure) {
  Record record = step_record();
  const Regulator narrow{.port_per_s = 0.3, .tube_per_s = 30, .spool_lag_s = 0, .chamber_share = 0};
  record.supply_kpa.assign(record.size(), 500.0);
  const std::vector<double> p = regulated(narrow, record, record.drive_kpa);
  // The flow is choked during almost the whole rise. The pressure therefore rises at a constant rate: 0.3 per
  // second times the absolute supply pressure of 601 kPa.
  EXPECT_NEAR(p[60] - p[55], 0.05 * 0.3 * 601.3, 0.5);
  record.supply_kpa.assign(record.size(), 300.0);
  EXPECT_NEAR(regulated(narrow, record, record.drive_kpa)[60], 401.3 / 601.3 * p[60], 0.5);
}

TEST(Regulator, LeakVentsTheFingerWhilePortsAreShut) {
  const Record record = record_of(std::vector<double>(200, 50.0), 0.01);
  Regulator shut{.dead_kpa = 1000, .chamber_share = 0, .leak_per_s = 0.02};
  const std::vector<double> p = regulated(shut, record, record.drive_kpa);
  EXPECT_NEAR(p.front(), 50, 1e-9);
  EXPECT_NEAR(p[0] - p[10], 0.1 * 0.02 * leaking_kpa_per_s(50), 0.02);
  EXPECT_LT(p.back(), 46);
  shut.leak_per_s = 0;
  EXPECT_NEAR(regulated(shut, record, record.drive_kpa).back(), 50, 1e-9);
}

/// The simulation divides a sampling interval of 0.1 s or 1 s into 50 steps. A simulation with ten times as
/// many steps must give nearly the same pressure.
TEST(Regulator, SlowSamplesNeedNoFinerSteps) {
  const Record slow = record_of(test::command_kpa(3, 120, 1), 1);
  constexpr std::size_t parts = 10;
  const Record fine = finer_record(slow, parts);
  for (const Regulator& regulator : {Regulator{}, Regulator{.port_per_s = 0.5, .leak_per_s = 0.01}}) {
    const std::vector<double> coarse_kpa = regulated(regulator, slow, slow.drive_kpa);
    const std::vector<double> fine_kpa = regulated(regulator, fine, fine.drive_kpa);
    std::vector<double> fine_at_samples_kpa;
    for (std::size_t i = 0; i < slow.size(); ++i) fine_at_samples_kpa.push_back(fine_kpa[i * parts]);
    EXPECT_LT(rms(coarse_kpa, fine_at_samples_kpa), 0.005 * slow.largest_kpa)
        << "the difference between the pressures must be below the resolution of a valve";
  }
}

TEST(Regulator, CompensatesALeakAtRestButRisesMoreSlowly) {
  const Record record = step_record();
  Regulator regulator{.play_kpa = 0, .dead_kpa = 1, .integral_per_s = 4};
  const std::vector<double> tight = regulated(regulator, record, record.drive_kpa);
  regulator.leak_per_s = 0.1;
  const std::vector<double> leaking = regulated(regulator, record, record.drive_kpa);
  EXPECT_NEAR(leaking.back(), tight.back(), 0.3);  // the leak causes a loss of 13 kPa/s, but the integral
                                                   // term of the controller compensates the loss
  EXPECT_LT(leaking[70], tight[70] - 0.2);
}

TEST(Regulator, SpoolLagCausesOvershoot) {
  const Record record = step_record();
  const auto most = [&](double spool_lag_s) {
    const Regulator regulator{
        .full_kpa = 5, .integral_per_s = 0.001, .port_per_s = 1, .spool_lag_s = spool_lag_s};
    const std::vector<double> p = regulated(regulator, record, record.drive_kpa);
    return *std::max_element(p.begin(), p.end());
  };
  EXPECT_LT(most(0), 50);
  EXPECT_GT(most(0.1), 54);
}

TEST(Regulator, DoesNotChatterBetweenALargeChamberAndATubeOfAnyWidth) {
  const Record record = step_record();
  for (const double tube_per_s : {50.0, 5000.0}) {
    const Regulator regulator{.port_per_s = 0.3, .tube_per_s = tube_per_s, .chamber_share = 1.5};
    const std::vector<double> p = regulated(regulator, record, record.drive_kpa);
    for (std::size_t i = 55; i < 65; ++i) EXPECT_GT(p[i], p[i - 1]) << tube_per_s;
    for (std::size_t i = 500; i < p.size(); ++i) EXPECT_NEAR(p[i], p[i - 1], 0.01) << tube_per_s;
  }
}

TEST(Regulator, ChamberVolumeSlowsThePressureRise) {
  const Record record = step_record();
  const auto soon = [&](double chamber_share) {
    const Regulator regulator{.port_per_s = 0.3, .tube_per_s = 30, .chamber_share = chamber_share};
    return regulated(regulator, record, record.drive_kpa)[60];
  };
  EXPECT_NEAR(soon(0) / soon(1), 2, 0.1);
}

/// Returns the pressure of the reference solution. It uses the valve of tests/blind/textbook, which follows
/// the same standard (ISO 6358-1) and is integrated in small explicit steps.
std::vector<double> textbook_pressure(const textbook::ValveNumbers& numbers, const Record& record) {
  constexpr double step_s = 0.00025;
  textbook::Valve valve(numbers);
  std::vector<double> p(record.size(), 0.0);
  for (std::size_t i = 1; i < p.size(); ++i) {
    const int steps = static_cast<int>(std::lround(record.duration_s[i] / step_s));
    for (int k = 0; k < steps; ++k) {
      const double part = (k + 0.5) / steps;
      valve.step((1 - part) * record.drive_kpa[i - 1] + part * record.drive_kpa[i], record.supply_kpa[i],
                 step_s);
    }
    p[i] = valve.gauge_kpa();
  }
  return p;
}

TEST(Regulator, MatchesAnIndependentIso6358Simulation) {
  textbook::ValveNumbers numbers;
  const double per_finger = textbook::reference_kpa / numbers.finger_volume_dm3;
  for (const double leak : {0.0, 1e-4}) {
    numbers.leak_conductance = leak;
    const Regulator regulator{.play_kpa = numbers.pilot_hysteresis_kpa,
                              .dead_kpa = numbers.overlap / numbers.proportional_per_kpa,
                              .full_kpa = (1 - numbers.overlap) / numbers.proportional_per_kpa,
                              .integral_per_s = numbers.integral_per_kpa_s / numbers.proportional_per_kpa,
                              .port_per_s = per_finger * numbers.port_conductance,
                              .tube_per_s = per_finger * numbers.tube_conductance,
                              .spool_lag_s = numbers.spool_lag_s,
                              .chamber_share = numbers.valve_volume_dm3 / numbers.finger_volume_dm3,
                              .leak_per_s = per_finger * leak};
    for (Record record : {step_record(), record_of(test::command_kpa(3, 6000, 100), 0.01)}) {
      record.supply_kpa.assign(record.size(), 400.0);
      const std::vector<double> p = textbook_pressure(numbers, record);
      const double far_kpa = rms(record.drive_kpa, p);
      EXPECT_GT(far_kpa, 0.3);
      EXPECT_LT(rms(regulated(regulator, record, record.drive_kpa), p), 0.08 * far_kpa) << leak;
      // The regulator is simulated with steps as small as the steps of the reference solution. The difference
      // between the two pressures must then be small.
      constexpr std::size_t parts = 40;
      const Record fine = finer_record(record, parts);
      const std::vector<double> at_all = regulated(regulator, fine, fine.drive_kpa);
      std::vector<double> at_samples(record.size());
      for (std::size_t i = 0; i < record.size(); ++i) at_samples[i] = at_all[i * parts];
      EXPECT_LT(rms(at_samples, p), 0.015 * far_kpa) << leak;
    }
  }
}

TEST(RegulatorFit, RecoversARegulatorFromMeasuredPressure) {
  const Regulator truth{.play_kpa = 0.2,
                        .dead_kpa = 0.9,
                        .full_kpa = 15,
                        .integral_per_s = 3,
                        .port_per_s = 3,
                        .tube_per_s = 6,
                        .spool_lag_s = 0.02,
                        .chamber_share = 0.3};
  Record record = record_of(test::command_kpa(3, 6000, 100), 0.01);
  const std::vector<double> p = regulated(truth, record, record.drive_kpa);
  for (std::size_t i = 0; i < p.size(); ++i) record.reading_mm[i] = 1.01 * p[i] + 0.5;
  const Regulator found = fit_regulator({record}, 60, ReadBy::gauge);
  EXPECT_LT(rms(behind(found, record).drive_kpa, p), 0.02);
  EXPECT_NEAR(found.integral_per_s, truth.integral_per_s, 0.3);
}

TEST(RegulatorFit, RecoversThePressureFromFingerDisplacement) {
  const Regulator truth{.play_kpa = 0.3,
                        .dead_kpa = 0.9,
                        .full_kpa = 20,
                        .integral_per_s = 1,
                        .port_per_s = 2,
                        .tube_per_s = 5};
  Record record = record_of(test::command_kpa(3, 6000, 100), 0.01);
  const std::vector<double> p = regulated(truth, record, record.drive_kpa);
  double play = 0, creep = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    play = std::clamp(play, p[i] - 3, p[i] + 3);
    creep += (p[i] - creep) / 400;
    record.reading_mm[i] = 0.2 * (0.6 * p[i] + 0.3 * play + 0.1 * creep);
  }
  const Regulator found = fit_regulator({record}, 60);
  const double far_kpa = rms(record.drive_kpa, p);
  EXPECT_GT(far_kpa, 0.5);
  EXPECT_LT(rms(behind(found, record).drive_kpa, p), 0.2 * far_kpa);
}

}  // namespace

}  // namespace softgrip::sysid::regulator_test
