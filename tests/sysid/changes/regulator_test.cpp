#include "sysid/changes/regulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::regulator_test {
namespace {

Record record_of(const std::vector<double>& command_kpa, double interval_s) {
  Log log;
  for (std::size_t i = 0; i < command_kpa.size(); ++i) {
    log.time_s.push_back(static_cast<double>(i) * interval_s);
    log.displacement_mm.push_back(0);
  }
  log.pressure_command_kpa = command_kpa;
  return make_records({log}, {}).front();
}

/// A step up after half a second.
Record step_record() {
  std::vector<double> command(600, 50.0);
  std::fill(command.begin(), command.begin() + 50, 0.0);
  return record_of(command, 0.01);
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Regulator, ItsIntegralTakesAwayWhatItsOverlapLeaves) {
  const Record record = step_record();
  Regulator overlapping{.play_kpa = 0.1, .dead_kpa = 3, .integral_per_s = 2};
  const std::vector<double> p = regulated(overlapping, record, record.drive_kpa);
  EXPECT_EQ(p[49], 0);
  EXPECT_NEAR(p.back(), 50, 0.3);
  overlapping.integral_per_s = 0.001;
  EXPECT_NEAR(regulated(overlapping, record, record.drive_kpa).back(), 47, 0.3);
}

TEST(Regulator, APortThatIsOpenFillsByWhatStandsBeforeIt) {
  Record record = step_record();
  const Regulator narrow{.port_per_s = 0.3, .tube_per_s = 30, .spool_lag_s = 0, .chamber_share = 0};
  record.supply_kpa.assign(record.size(), 500.0);
  const std::vector<double> p = regulated(narrow, record, record.drive_kpa);
  // Choked, nearly all the way: 601 kPa by 0.3 a second.
  EXPECT_NEAR(p[60] - p[55], 0.05 * 0.3 * 601.3, 0.5);
  record.supply_kpa.assign(record.size(), 300.0);
  EXPECT_NEAR(regulated(narrow, record, record.drive_kpa)[60], 401.3 / 601.3 * p[60], 0.5);
}

TEST(Regulator, WhilePortsAreShutALeakEmptiesTheFinger) {
  const Record record = record_of(std::vector<double>(200, 50.0), 0.01);
  Regulator shut{.dead_kpa = 1000, .chamber_share = 0, .leak_per_s = 0.02};
  const std::vector<double> p = regulated(shut, record, record.drive_kpa);
  EXPECT_NEAR(p.front(), 50, 1e-9);
  EXPECT_NEAR(p[0] - p[10], 0.1 * 0.02 * leaking_kpa_per_s(50), 0.02);
  EXPECT_LT(p.back(), 46);
  shut.leak_per_s = 0;
  EXPECT_NEAR(regulated(shut, record, record.drive_kpa).back(), 50, 1e-9);
}

TEST(Regulator, AnswersForALeakWhereItsPortsOpen) {
  const Record record = step_record();
  Regulator regulator{.play_kpa = 0, .dead_kpa = 1, .integral_per_s = 4};
  const std::vector<double> tight = regulated(regulator, record, record.drive_kpa);
  regulator.leak_per_s = 0.1;
  const std::vector<double> leaking = regulated(regulator, record, record.drive_kpa);
  EXPECT_NEAR(leaking.back(), tight.back(), 0.3);  // of 13 kPa that it loses a second
  EXPECT_LT(leaking[70], tight[70] - 0.2);
}

TEST(Regulator, ASpoolThatLagsOvershoots) {
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

TEST(Regulator, AChamberBeforeTheTubeIsFilledFirst) {
  const Record record = step_record();
  const auto soon = [&](double chamber_share) {
    const Regulator regulator{.port_per_s = 0.3, .tube_per_s = 30, .chamber_share = chamber_share};
    return regulated(regulator, record, record.drive_kpa)[60];
  };
  EXPECT_NEAR(soon(0) / soon(1), 2, 0.1);
}

TEST(Regulator, IsFoundFromItsPressure) {
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

TEST(Regulator, IsFoundFromWhatAFingerBehindItDoes) {
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
