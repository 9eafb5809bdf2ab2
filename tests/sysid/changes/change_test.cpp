#include "sysid/changes/change.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "base/numbers.h"
#include "sysid/changes/change_report.h"
#include "sysid/changes/next_steps.h"
#include "sysid/changes/regulator.h"
#include "sysid/logs/resampled_record.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::change_test {
namespace {

using test::Finger;
using test::log_of;
using test::logs_of;

ChangeDiagnosis changed(const Finger& later, bool with_pressure = false) {
  const auto diagnosis = diagnose_change(logs_of({}, 1, with_pressure), logs_of(later, 5, with_pressure));
  EXPECT_TRUE(diagnosis) << diagnosis.error();
  return *diagnosis;
}

TEST(Change, DifferentInputAndZeroOffsetAreNoChange) {
  const ChangeDiagnosis d = changed({.zero_mm = 0.4});
  EXPECT_EQ(d.verdict, ChangeVerdict::unchanged) << change_sentence(d);
  EXPECT_NEAR(d.readings.back().zero_mm, 0.4, 0.03);
  const std::string permitted = significant(d.readings.back().allowed_mm, 2) + " mm";
  EXPECT_EQ(
      change_sentence(d),
      "Unchanged: the errors of the later logs are within the error permitted for a further healthy run (" +
          permitted + ").");
  for (const TriedCause& tried : d.readings.back().tried) EXPECT_NE(tried.rejected, "") << tried.id;
}

TEST(Change, ZeroOffsetIsRelativeToTheHealthyLogs) {
  for (const std::size_t runs : {1U, 2U}) {
    std::vector<Log> healthy = logs_of({.zero_mm = 0.3}, 1);
    healthy.resize(runs);
    const auto d = diagnose_change(healthy, logs_of({.zero_mm = 0.4}, 5));
    ASSERT_TRUE(d) << d.error();
    EXPECT_NEAR(d->readings.back().zero_mm, 0.1, 0.03) << runs << " healthy logs";
  }
}

bool may_be_a_weight(const ChangeCause& cause) {
  return std::count(cause.alternatives.begin(), cause.alternatives.end(), "payload") == 1;
}

/// A payload changes the gain and the zero offset at the same time.
TEST(Change, GainAndZeroChangeTogetherSuggestAPayload) {
  const ChangeDiagnosis d = changed({.gain = 0.2 * 0.95, .zero_mm = -0.4});
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "ageing");
  EXPECT_TRUE(may_be_a_weight(d.causes[0]));
}

/// Replaces the reading of sample i in the later logs by the reading of sample `sample(i)`, and returns the
/// diagnosis of these logs.
ChangeDiagnosis read_at(std::size_t (*sample)(std::size_t)) {
  std::vector<Log> later = logs_of({}, 5);
  for (Log& log : later) {
    const std::vector<double> truth_mm = log.displacement_mm;
    for (std::size_t i = 0; i < log.size(); ++i)
      log.displacement_mm[i] = truth_mm[std::min(sample(i), log.size() - 1)];
  }
  const auto diagnosis = diagnose_change(logs_of({}, 1), later);
  EXPECT_TRUE(diagnosis) << diagnosis.error();
  return *diagnosis;
}

TEST(Change, RarelyUpdatedReadingIsNamedSampling) {
  const ChangeDiagnosis d = read_at([](std::size_t i) { return i - i % 10; });
  ASSERT_EQ(d.causes.size(), 1U) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "sampling");
  EXPECT_NEAR(d.causes[0].size.value, 0.2, 1e-3);
  const auto reduction = result::json_of(fields_of(d))["causes"][0]["heldout_error_reduction_percent"];
  EXPECT_TRUE(reduction.at("value").is_null()) << "the cause was found without a fit";
}

TEST(Change, ACoarserReadingIsNamedSampling) {
  std::vector<Log> later = logs_of({}, 5);
  for (Log& log : later) {
    for (double& y : log.displacement_mm) y = 0.5 * std::round(y / 0.5);
  }
  const auto diagnosis = diagnose_change(logs_of({}, 1), later);
  ASSERT_TRUE(diagnosis) << diagnosis.error();
  ASSERT_EQ(diagnosis->causes.size(), 1U) << change_sentence(*diagnosis);
  EXPECT_EQ(diagnosis->causes[0].id, "sampling");
  EXPECT_NEAR(diagnosis->causes[0].size.value, 0.5, 1e-9);
}

/// Adds errors in every period of 5 s. The error alternates during the first 3 s. During the last 2 s, there
/// are single errors of twice the size. If the noise is underestimated, the single errors look like outliers.
std::vector<Log> humming(std::vector<Log> logs) {
  constexpr std::size_t per_s = 50;
  for (Log& log : logs) {
    for (std::size_t i = 0; i < log.size(); ++i) {
      if (i / per_s % 5 < 3) log.displacement_mm[i] += i % 2 == 0 ? 0.45 : -0.45;
      if (i / per_s % 5 >= 3 && i % 25 == 12) log.displacement_mm[i] += 0.9;
    }
  }
  return logs;
}

TEST(Change, SaturatedSensorWithLowNoiseHasNoOutliers) {
  std::vector<Log> later = humming(logs_of({}, 5));
  std::mt19937 random(5);
  std::normal_distribution<double> noise_mm(0, 0.001);
  std::size_t at_end = 0, all = 0;
  for (Log& log : later) {
    const double end_mm = 0.3 * *std::max_element(log.displacement_mm.begin(), log.displacement_mm.end());
    for (double& y : log.displacement_mm) {
      at_end += y > end_mm ? 1 : 0;
      if (y > end_mm) y = end_mm + noise_mm(random);
      ++all;
    }
  }
  ASSERT_GT(2 * at_end, all) << "more than half of the readings are at the saturation limit of the sensor";
  const auto d = diagnose_change(humming(logs_of({}, 1)), later);
  ASSERT_TRUE(d) << d.error();
  ASSERT_FALSE(d->causes.empty());
  for (const ChangeCause& cause : d->causes) EXPECT_NE(cause.id, "outliers") << change_sentence(*d);
}

// The oscillation does not begin with the log, so its phases in the two later logs are opposite.
TEST(Change, AnOscillationHasItsSizeAlthoughItsPhaseDiffersBetweenLogs) {
  constexpr double amplitude_mm = 0.1, frequency_hz = 3.3;
  std::vector<Log> later = logs_of({}, 5);
  for (std::size_t k = 0; k < later.size(); ++k) {
    for (std::size_t i = 0; i < later[k].size(); ++i)
      later[k].displacement_mm[i] +=
          amplitude_mm *
          std::sin(2 * std::numbers::pi * frequency_hz * later[k].time_s[i] + 3.0 * static_cast<double>(k));
  }
  const auto d = diagnose_change(logs_of({}, 1), later);
  ASSERT_TRUE(d) << d.error();
  ASSERT_EQ(d->causes.size(), 1U) << change_sentence(*d);
  EXPECT_EQ(d->causes[0].id, "periodic_disturbance") << change_sentence(*d);
  EXPECT_NEAR(d->causes[0].size.value, amplitude_mm, 0.1 * amplitude_mm);
}

TEST(Change, ReadingAheadOfTheCommandIsAClockOffset) {
  const ChangeDiagnosis d = read_at([](std::size_t i) { return i + 15; });
  ASSERT_EQ(d.causes.size(), 1U) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "clock_offset") << change_sentence(d);
  EXPECT_NEAR(d.causes[0].size.value, 0.3, 0.005);
}

TEST(Change, ZeroOffsetIsFoundIfThinnedRecordsAreOneBinShorter) {
  std::vector<Log> healthy = logs_of({}, 1), later = logs_of({.zero_mm = 0.4}, 5);
  for (std::vector<Log>* const logs : {&healthy, &later}) {
    for (Log& log : *logs) log = slice(log, 0, 1996);
  }
  const auto d = diagnose_change(healthy, later);
  ASSERT_TRUE(d) << d.error();
  EXPECT_EQ(d->verdict, ChangeVerdict::unchanged) << change_sentence(*d);
  EXPECT_NEAR(d->readings.back().zero_mm, 0.4, 0.03);
}

TEST(Change, GainChangeIsReportedAsAgeingInPercent) {
  const ChangeDiagnosis d = changed({.gain = 0.2 * 1.03});
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "ageing");
  EXPECT_EQ(d.causes[0].size.unit, "%");
  EXPECT_NEAR(d.causes[0].size.value, 3, 0.4);
  ASSERT_TRUE(d.causes[0].intervals.size);
  EXPECT_LT(d.causes[0].intervals.size->lower, 2.8);
  EXPECT_GT(d.causes[0].intervals.size->upper, 3.2);
  // The result lists all tested causes. It states the reason for each rejected cause.
  const JudgedChange& judged = d.readings.back();
  EXPECT_EQ(judged.healthy_runs, logs_of({}, 1).size());
  EXPECT_GT(judged.healthy_mm, 0);
  EXPECT_GT(judged.allowed_mm, judged.healthy_mm);
  std::size_t rejected = 0;
  for (const TriedCause& tried : judged.tried) {
    if (!tried.rejected.empty()) ++rejected;
    EXPECT_FALSE(tried.id == "ageing" && !tried.rejected.empty()) << tried.rejected;
    EXPECT_EQ(tried.rejected == "the data never meet the condition under which the effect occurs",
              judged.not_tested.contains(tried.id))
        << tried.id;
  }
  EXPECT_GT(rejected, 0U);
  EXPECT_TRUE(judged.not_tested.contains("sensor_drift"));
  ASSERT_EQ(judged.runs.size(), judged.healthy_runs + judged.logs.size());
  for (std::size_t k = 0; k < judged.runs.size(); ++k) {
    const RunLeft& run = judged.runs[k];
    EXPECT_EQ(run.is_healthy, k < judged.healthy_runs);
    EXPECT_GT(run.base, 0) << run.run;
    if (run.is_healthy) {
      EXPECT_EQ(run.explained, run.base) << run.run;
    } else {
      EXPECT_LT(run.explained, run.base) << run.run;
    }
  }
}

TEST(Change, WithOneHealthyLogASmallGainDifferenceIsNoChange) {
  const auto is_changed = [](double gain) {
    const auto d = diagnose_change({log_of({}, 1)}, {log_of({.gain = gain}, 5)});
    EXPECT_TRUE(d) << d.error();
    const bool changed = d->verdict != ChangeVerdict::unchanged;
    EXPECT_EQ(std::count_if(d->warnings.begin(), d->warnings.end(),
                            [](const std::string& text) {
                              return text.starts_with("No healthy log has the same command as log5.");
                            }),
              changed ? 1 : 0);
    return changed;
  };
  EXPECT_FALSE(is_changed(0.2 * 0.9555));  // would be ageing if the permitted difference were only 0.8 %
  EXPECT_TRUE(is_changed(0.2 * 0.94));
}

TEST(Change, ThermalGainRefersToTheMeanHealthyTemperature) {
  const auto d = diagnose_change(logs_of({.with_temperature = true}, 1),
                                 logs_of({.per_c = 0.01, .with_temperature = true}, 5));
  ASSERT_TRUE(d) << d.error();
  ASSERT_FALSE(d->causes.empty()) << change_sentence(*d);
  EXPECT_EQ(d->causes[0].id, "thermal_gain");
  EXPECT_EQ(d->causes.size(), 1U);
  // The change per degree refers to the gain at 24 degC, the mean temperature of the healthy logs.
  EXPECT_NEAR(d->causes[0].size.value, 100 * 0.01 / (1 + 0.01 * (24 - 15)), 0.1);
}

TEST(Change, ZeroDriftPresentInHealthyLogsIsNoChange) {
  const auto d = diagnose_change(logs_of({.drift_mm = 0.1}, 1), logs_of({.drift_mm = 0.1}, 5));
  ASSERT_TRUE(d) << d.error();
  EXPECT_EQ(d->verdict, ChangeVerdict::unchanged) << change_sentence(*d);
}

TEST(Change, StopIsSizedByTheShortfallAtFullPressure) {
  const ChangeDiagnosis d = changed({.stop_mm = 7});
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  const ChangeCause& cause = d.causes[0];
  const bool named = cause.id == "contact" || cause.id == "sensor_saturation";
  EXPECT_TRUE(named) << cause.id;
  // The expected size is the mean displacement shortfall where the pressure is at least 90 % of the highest
  // pressure.
  const std::vector<Log> stopped = logs_of({.stop_mm = 7}, 5), free = logs_of({}, 5);
  double highest_kpa = 0, missing_mm = 0, count = 0;
  for (const Log& log : free)
    for (const double p : log.pressure_command_kpa) highest_kpa = std::max(highest_kpa, p);
  for (std::size_t l = 0; l < free.size(); ++l) {
    for (std::size_t i = 0; i < free[l].size(); ++i) {
      if (free[l].pressure_command_kpa[i] < 0.9 * highest_kpa) continue;
      missing_mm += free[l].displacement_mm[i] - stopped[l].displacement_mm[i];
      count += 1;
    }
  }
  EXPECT_NEAR(cause.full_pressure_mm, -missing_mm / count, 0.2);
}

TEST(Change, StiffeningHasSensorNonlinearityAsAlternative) {
  const ChangeDiagnosis d = changed({.bend_per_mm = 0.02});
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "stiffening");
  const auto& found = d.causes[0].fitted;
  EXPECT_NEAR(found.numbers.at(0), 0.02, 0.002);
  EXPECT_NEAR(found.numbers.at(1), 12 * 0.02, 0.02);
  // With two healthy logs, the permitted gain difference is so large that softening explains the change too.
  EXPECT_EQ(d.causes[0].alternatives, (std::vector<std::string>{"sensor_nonlinearity", "stress_softening"}));
  EXPECT_EQ(d.verdict, ChangeVerdict::ambiguous);
}

TEST(Change, SofteningWithDisplacementIsNamedSensorNonlinearity) {
  const ChangeDiagnosis d = changed({.bend_per_mm = -0.02});
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "sensor_nonlinearity");
  EXPECT_EQ(d.causes[0].fitted.effect.numbers[0].name, "bow_mm");
  EXPECT_LT(d.causes[0].fitted.numbers[0], 0);
}

TEST(Change, CrescentLoopIsNamedAsymmetricHysteresis) {
  const ChangeDiagnosis d = changed({.crescent_mm = 0.4});
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "asymmetric_hysteresis");
  EXPECT_EQ(d.causes[0].fitted.effect.form, "crescent");
  EXPECT_NEAR(d.causes[0].fitted.numbers.at(1), 2, 0.3);
}

TEST(Change, SaturationJustBelowTheLargestReadingIsFound) {
  double largest_mm = 0;
  for (const Log& log : logs_of({}, 5))
    largest_mm =
        std::max(largest_mm, *std::max_element(log.displacement_mm.begin(), log.displacement_mm.end()));
  // The limit of the sensor is 0.25 mm below the largest reading. The first start value of the search is
  // computed from the error, and is larger than all readings.
  const double end_mm = largest_mm - 0.25;
  const ChangeDiagnosis d = changed({.stop_mm = end_mm});
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "sensor_saturation");
  ASSERT_TRUE(d.causes[0].intervals.numbers.at(0));
  EXPECT_LT(d.causes[0].intervals.numbers[0]->lower, end_mm);
  EXPECT_GT(d.causes[0].intervals.numbers[0]->upper, end_mm);
}

TEST(Change, APositionIsStatedInTheReadings) {
  // The zero of both groups of logs is far from the zero of the baseline model.
  constexpr double zero_mm = 4, stop_mm = 8;
  const auto healthy = logs_of({.zero_mm = zero_mm}, 1),
             later = logs_of({.stop_mm = stop_mm, .zero_mm = zero_mm}, 5);
  const auto d = diagnose_change(healthy, later, {});
  ASSERT_TRUE(d && !d->causes.empty());
  const ChangeCause& cause = d->causes[0];
  EXPECT_TRUE(cause.id == "contact" || cause.id == "sensor_saturation") << cause.id;
  EXPECT_NEAR(cause.intervals.values.at(0), zero_mm + stop_mm, 0.3);
  EXPECT_NEAR(cause.fitted.numbers.at(0), stop_mm, 0.3) << "in the model, the zero is subtracted";
  ASSERT_TRUE(cause.intervals.numbers.at(0));
  EXPECT_LT(cause.intervals.numbers[0]->lower, zero_mm + stop_mm);
  EXPECT_GT(cause.intervals.numbers[0]->upper, zero_mm + stop_mm);
}

TEST(Change, LeakIsFoundInThePressureRecordOnly) {
  const ChangeDiagnosis d = changed({.lost_kpa_per_s = 0.8}, true);
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "leak");
  EXPECT_EQ(d.causes[0].judged, Judged::pressure);
  EXPECT_EQ(d.causes.size(), 1U);
}

/// Replaces the pressure in the logs by the pressure at the output of a simulated regulator. This simulation
/// does not use the regulator equations of the project. If the sum of the control error and its integral
/// leaves a dead zone, a port to a chamber opens. Air flows from the chamber through a narrow tube into the
/// finger, and from the finger through a leak.
std::vector<Log> behind_a_regulator(std::vector<Log> logs, double tube_per_s, double leak_per_s) {
  std::mt19937 random(static_cast<unsigned>(1000 * leak_per_s + tube_per_s));
  std::normal_distribution<double> noise(0, 0.03);
  for (Log& log : logs) {
    double chamber = 0, p = 0, integral = 0, play = 0;
    for (std::size_t i = 0; i < log.size(); ++i) {
      constexpr int parts = 50;
      for (int k = 0; k < parts; ++k) {
        constexpr double dt = 0.02 / parts;
        const double way = (k + 0.5) / parts, before = log.pressure_command_kpa[i > 0 ? i - 1 : 0];
        const double error = before + way * (log.pressure_command_kpa[i] - before) - chamber;
        const double asked = error + integral, above = chamber - p;
        const double through = tube_per_s * above / std::sqrt(std::abs(above) + 0.05);
        integral += 3 * error * dt;
        const double beyond = std::abs(asked) > 2 ? asked - std::copysign(2.0, asked) : 0;
        chamber += dt * (25 * beyond - through) / 0.2;
        p += dt * (through - leak_per_s * p);
      }
      play = std::clamp(play, p - 3, p + 3);
      log.pressure_kpa[i] = p + noise(random);
      log.displacement_mm[i] = 0.2 * (0.7 * p + 0.3 * play) + noise(random);
    }
  }
  return logs;
}

ChangeDiagnosis changed_behind_a_regulator(double tube_per_s, double leak_per_s) {
  // Each log must last at least one minute, because the diagnosis does not find a small leak in shorter logs.
  // The commands of the later logs are not farther from the pressure than those of the healthy logs.
  const auto d = diagnose_change(behind_a_regulator(logs_of({}, 1, true, 3000), 40, 0),
                                 behind_a_regulator(logs_of({}, 3, true, 3000), tube_per_s, leak_per_s));
  EXPECT_TRUE(d) << d.error();
  return *d;
}

TEST(Change, LeakCompensatedByARegulatorIsFound) {
  const ChangeDiagnosis d = changed_behind_a_regulator(40, 0.2);
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "leak");
  EXPECT_EQ(d.causes[0].fitted.effect.form, "leak_past_a_regulator");
  EXPECT_EQ(d.causes.size(), 1U) << change_sentence(d);
  // The pressure reaches 58 kPa, and the finger loses 20 % of its pressure per second through the leak. The
  // simulation and the diagnosis use different flow equations for the leak, so the two loss rates can differ
  // by a factor of 2.
  EXPECT_GT(d.causes[0].size.value, 0.5 * 0.2 * 58);
  EXPECT_LT(d.causes[0].size.value, 2 * 0.2 * 58);
}

TEST(Change, NarrowerTubeBehindARegulatorIsABlockedLine) {
  const ChangeDiagnosis d = changed_behind_a_regulator(24, 0);
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "blocked_line");
}

/// Returns logs whose pressure comes from the regulator model of the project.
std::vector<Log> regulated_logs(unsigned first_seed, const Regulator& regulator) {
  std::mt19937 random(first_seed);
  std::normal_distribution<double> noise(0, 0.03);
  std::vector<Log> logs = logs_of({}, first_seed, true);
  for (Log& log : logs) {
    const Record record = make_records({log}, {}).front();
    log.pressure_kpa = regulated(regulator, record, record.drive_kpa);
    for (std::size_t i = 0; i < log.size(); ++i) {
      log.displacement_mm[i] = 0.2 * log.pressure_kpa[i] + noise(random);
      log.pressure_kpa[i] += noise(random);
    }
  }
  return logs;
}

constexpr Regulator healthy_regulator{.full_kpa = 15, .port_per_s = 3, .tube_per_s = 5};

ChangeDiagnosis changed_from_healthy(const Regulator& later) {
  const auto d = diagnose_change(regulated_logs(1, healthy_regulator), regulated_logs(5, later));
  EXPECT_TRUE(d) << d.error();
  return *d;
}

TEST(Change, BlockedLineBehindAKnownRegulatorIsSizedInPercent) {
  Regulator regulator = healthy_regulator;
  regulator.tube_per_s = 3;
  const ChangeDiagnosis d = changed_from_healthy(regulator);
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].fitted.effect.form, "narrower_tube");
  EXPECT_EQ(d.causes[0].size.unit, "%");
  EXPECT_NEAR(d.causes[0].size.value, 40, 8);
}

TEST(Change, LeakBehindAKnownRegulatorIsSizedByPressureLoss) {
  Regulator regulator = healthy_regulator;
  regulator.leak_per_s = 0.05;
  const ChangeDiagnosis d = changed_from_healthy(regulator);
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "leak");
  EXPECT_EQ(d.causes[0].size.unit, "kPa");
  EXPECT_NEAR(d.causes[0].size.value, 0.05 * leaking_kpa_per_s(58), 0.5);
}

TEST(Change, UnchangedRegulatorIsReportedUnchanged) {
  const ChangeDiagnosis d = changed_behind_a_regulator(40, 0);
  EXPECT_EQ(d.verdict, ChangeVerdict::unchanged) << change_sentence(d);
  EXPECT_EQ(d.readings.front().base, "a regulator");
}

TEST(Change, DelayedPressureIsATransportDelayInSeconds) {
  const ChangeDiagnosis d = changed({.delay_s = 0.1});
  ASSERT_FALSE(d.causes.empty()) << change_sentence(d);
  EXPECT_EQ(d.causes[0].id, "transport_delay");
  EXPECT_NEAR(d.causes[0].size.value, 0.1, 0.02);
}

void expect_keys_of_every_diagnosis(const ChangeDiagnosis& d) {
  const auto json = result::json_of(fields_of(d));
  for (const char* const key : {"schema", "verdict", "causes", "alternatives", "noise_mm", "heldout_rmse_mm",
                                "gain_percent", "unexplained_percent", "next_experiment", "warnings"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["causes"].size(), json["alternatives"].size());
  const auto& gain = json["causes"][0]["parameters"]["gain_change"];
  EXPECT_LT(gain["ci95"][0], gain["value"]);
  EXPECT_LT(gain["value"], gain["ci95"][1]);
  EXPECT_LT(json["causes"][0]["size"]["ci95"][0], -4.9);
  EXPECT_GT(json["causes"][0]["size"]["ci95"][1], -5.1);
  EXPECT_LT(json["heldout_rmse_mm"]["extended"], json["heldout_rmse_mm"]["as_given"]);
  const auto& reading = json["readings"][0];
  EXPECT_GT(reading["whitened_loss"]["before"], reading["whitened_loss"]["left"]);
  EXPECT_EQ(reading["misfit"], reading["whitened_loss"]) << "misfit is the deprecated name of whitened_loss";
  EXPECT_TRUE(reading["unexplained"].is_boolean());
  EXPECT_EQ(reading["structure_left"], reading["unexplained"])
      << "structure_left is the deprecated name of unexplained";
  EXPECT_EQ(reading["structure"], reading["base"]) << "base is the deprecated name of structure";
  EXPECT_EQ(json["structure"], json["base"]);
  EXPECT_FALSE(json["structure"].is_null());
  EXPECT_GT(json["error_reduction_percent"]["value"], 0);
  EXPECT_EQ(json["error_reduction_percent"], json["gain_percent"]);
  const auto& reduction = json["causes"][0]["heldout_error_reduction_percent"];
  EXPECT_GT(reduction["value"], 0);
  EXPECT_LT(reduction["ci95"][1], 100);
  EXPECT_LE(reduction["ci95"][0], reduction["value"]);
  EXPECT_GE(reduction["ci95"][1], reduction["value"]);
  EXPECT_EQ(reduction, json["causes"][0]["heldout_gain_percent"]);
}

TEST(ChangeResult, WithOneHealthyLogTheSentenceStatesWhichErrorWouldBeReported) {
  ChangeDiagnosis d;
  d.verdict = ChangeVerdict::unchanged;
  d.readings.resize(2);
  for (JudgedChange& judged : d.readings) {
    judged.healthy_runs = 1;
    judged.healthy_mm = 0.5;
    judged.allowed_mm = 1.5;
    judged.later_mm = 0.4;
  }
  EXPECT_EQ(change_sentence(d),
            "Unchanged: the error of the later logs does not exceed the error between the two halves of the "
            "healthy log.");
  d.readings[1].later_mm = 0.8;
  EXPECT_EQ(
      change_sentence(d),
      "No change is detectable with one healthy log: the error of the later logs is 1.6 times the error "
      "between the two halves of the healthy log, and a change is reported only above 3 times. Record "
      "three or more healthy logs.");
  d.readings[0].healthy_runs = 3;
  EXPECT_EQ(change_sentence(d).find("one healthy log"), std::string::npos);
}

TEST(ChangeResult, UnexplainedErrorForAnotherCommandMayBeAModelError) {
  ChangeDiagnosis d;
  d.verdict = ChangeVerdict::unexplained;
  EXPECT_EQ(
      change_sentence(d),
      "The finger has changed since the healthy logs, but no cause of the library explains the change.");
  d.another_command = "today";
  EXPECT_EQ(
      change_sentence(d),
      "The later logs differ from the prediction of the baseline model, and no cause of the library "
      "explains the difference. The reason is a change of the finger or an error of the model, because no "
      "healthy log has the command of today.");
}

JudgedChange judged_with(double later_mm, double explained_mm, double loss_before, double loss_left) {
  JudgedChange judged;
  judged.healthy_mm = 1;
  judged.later_mm = later_mm;
  judged.explained_mm = explained_mm;
  judged.loss_before = loss_before;
  judged.loss_left = loss_left;
  return judged;
}

TEST(ChangeResult, ExplainedShareIsTheLargerOneOfTwoShares) {
  EXPECT_DOUBLE_EQ(share_explained(judged_with(3, 1, 5, 5)), 1.0);
  EXPECT_DOUBLE_EQ(share_explained(judged_with(3, std::sqrt(7), 5, 4)), 0.25);
  EXPECT_DOUBLE_EQ(share_explained(judged_with(3, std::sqrt(7), 5, 2)), 0.75);
  EXPECT_DOUBLE_EQ(share_explained(judged_with(3, 3.2, 5, 5)), 0.0);
  EXPECT_DOUBLE_EQ(share_explained(judged_with(3, 0.5, 5, 5)), 1.0) << "at most 1";
  EXPECT_DOUBLE_EQ(share_explained(judged_with(0.9, 0.8, 5, 4)), 0.25) << "no excess error without whitening";
  EXPECT_DOUBLE_EQ(share_explained(judged_with(0.9, 0.8, 0.9, 0.8)), 0.0) << "no excess error";
}

TEST(ChangeResult, PartialCausesAreStatedAfterTheVerdict) {
  ChangeDiagnosis d;
  d.verdict = ChangeVerdict::unexplained;
  d.readings.push_back(judged_with(3, std::sqrt(6.12), 5, 5));
  ChangeCause& cause = d.partial.emplace_back();
  cause.id = "valve_lag";
  cause.size = {"increase of the lag of the valve", 0.03, "s"};
  cause.alternatives = {"sensor_lag"};
  EXPECT_EQ(
      change_sentence(d),
      "The finger has changed since the healthy logs, but no cause of the library explains the change. The "
      "following explanation accounts for only 36 % of the additional error of the displacement, so it is "
      "not "
      "reported as the cause: the pressure responds more slowly than before (valve_lag: increase of the lag "
      "of "
      "the valve 0.03 s), or the reading responds more slowly than before (sensor_lag).");
  const std::string json = result::json_text(fields_of(d));
  EXPECT_LT(json.find("partial_causes"), json.find("\"valve_lag\"")) << json;
}

TEST(ChangeResult, ParametersHaveTheDeprecatedNameBesideTheName) {
  ChangeDiagnosis d;
  d.readings.emplace_back();
  ChangeCause& cause = d.causes.emplace_back();
  cause.id = "stress_softening";
  cause.fitted.effect.numbers = {{"saturation_per_kpa", "1/kPa", 1, 0, 1, "levelling_per_kpa"},
                                 {"softening_per_kpa", "1/kPa", 1, 0, 1}};
  cause.fitted.numbers = {0.02, 0.004};
  cause.intervals.values = cause.fitted.numbers;
  cause.intervals.numbers = {std::nullopt, std::nullopt};
  const auto parameters = result::json_of(fields_of(d))["causes"][0]["parameters"];
  EXPECT_EQ(parameters.size(), 3U);
  EXPECT_EQ(parameters["saturation_per_kpa"]["value"], 0.02);
  EXPECT_EQ(parameters["levelling_per_kpa"], parameters["saturation_per_kpa"]);
}

void expect_page_with_next_steps(const ChangeDiagnosis& d) {
  const Page page = change_page(d, logs_of({}, 1), logs_of({}, 5), {});
  const std::string html = page.to_html();
  EXPECT_NE(html.find("Next steps for ageing"), std::string::npos);
  EXPECT_NE(html.find(interval_text(d.causes[0])), std::string::npos) << interval_text(d.causes[0]);
  EXPECT_NE(html.find(std::string(next_steps("ageing")[1]).substr(0, 30)), std::string::npos);
  ASSERT_EQ(page.figures().size(), 3U);
  EXPECT_EQ(page.figures()[0].charts.size(), 2U);  // one chart for each log
  const Chart& runs = page.figures()[1].charts[0][0];
  EXPECT_EQ(runs.x.categories.size(), d.readings.back().runs.size());
  EXPECT_EQ(runs.series.size(), 2U);
}

/// One diagnosis of a gain change, which takes seconds, serves several checks: of the cause, the searches,
/// the JSON and the page.
TEST(Change, SmallerGainIsAgeingInTheJsonAndOnThePage) {
  ChangeOptions options;
  std::size_t searches = 0;
  options.progress = [&](const std::string& stage) {
    if (stage == "search for changes in the later logs") ++searches;
  };
  const auto d = diagnose_change(logs_of({}, 1), logs_of({.gain = 0.2 * 0.95}, 5), options);
  ASSERT_TRUE(d) << d.error();
  ASSERT_FALSE(d->causes.empty()) << change_sentence(*d);
  EXPECT_EQ(d->causes[0].id, "ageing");
  EXPECT_FALSE(may_be_a_weight(d->causes[0])) << "only the gain has changed, but not the zero offset";
  EXPECT_EQ(searches, d->causes.size())
      << "the last cause leaves no error that a further search could reduce";
  expect_keys_of_every_diagnosis(*d);
  expect_page_with_next_steps(*d);
}

TEST(Change, TooShortOrMissingHealthyLogsAreRejected) {
  std::vector<Log> short_logs = logs_of({}, 1);
  short_logs.resize(1);
  short_logs[0] = slice(short_logs[0], 0, 100);
  EXPECT_FALSE(diagnose_change(short_logs, logs_of({}, 5)));
  EXPECT_FALSE(diagnose_change({}, logs_of({}, 5)));
}

/// Because of a lag of 0.01 s, the error is larger than in the healthy runs, but smaller than the limit for a
/// further run. If the later run starts like the healthy runs, the diagnosis finds the lag. If the later run
/// starts under pressure, the diagnosis does not find the lag.
TEST(Change, DifferentStartStateNeedsALargerError) {
  const std::vector<Log> healthy{log_of({}, 1), log_of({}, 2), log_of({}, 3)};
  const Log at_rest = log_of({.valve_lag_s = 0.01}, 5);
  const std::vector<double>& command = at_rest.pressure_command_kpa;
  const auto first = std::find_if(command.begin(), command.end(), [](double kpa) { return kpa > 25; });
  const Log under_pressure =
      slice(at_rest, static_cast<std::size_t>(first - command.begin()), at_rest.size());
  const auto diagnosis_of = [&](const Log& later) {
    const auto d = diagnose_change(healthy, {later});
    EXPECT_TRUE(d) << d.error();
    EXPECT_GT(d->readings.back().later_mm, d->readings.back().healthy_mm);
    EXPECT_LT(d->readings.back().later_mm, d->readings.back().allowed_mm);
    return *d;
  };
  const ChangeDiagnosis alike = diagnosis_of(at_rest), other = diagnosis_of(under_pressure);
  ASSERT_EQ(alike.causes.size(), 1U) << change_sentence(alike);
  EXPECT_EQ(alike.causes[0].id, "valve_lag");
  EXPECT_EQ(other.verdict, ChangeVerdict::unchanged) << change_sentence(other);
  EXPECT_TRUE(std::any_of(other.warnings.begin(), other.warnings.end(), [](const std::string& warning) {
    return warning.find("No healthy log begins in the same state (pressurised or vented) as") == 0;
  }));
}

std::vector<Log> healthy_with_varied_gain(std::size_t runs) {
  std::vector<Log> healthy{log_of({.gain = 0.2 * 1.01}, 1), log_of({.gain = 0.2 * 0.99}, 2), log_of({}, 3)};
  healthy.resize(runs);
  return healthy;
}

double mean_at_full_pressure(const Log& log) {
  const std::vector<double>& command = log.pressure_command_kpa;
  const double full_kpa = *std::max_element(command.begin(), command.end());
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (command[i] < 0.9 * full_kpa) continue;
    sum += log.displacement_mm[i];
    count += 1;
  }
  return sum / count;
}

TEST(Change, AGainChangeIsFoundAndWholeInEachNumber) {
  for (const std::size_t runs : {2U, 3U}) {
    const Log later = log_of({.gain = 0.2 * 0.9}, 5);
    const auto d = diagnose_change(healthy_with_varied_gain(runs), {later});
    ASSERT_TRUE(d) << d.error();
    ASSERT_EQ(d->causes.size(), 1U) << runs << " healthy logs: " << change_sentence(*d);
    const ChangeCause& cause = d->causes.front();
    EXPECT_EQ(cause.id, "ageing");
    EXPECT_NEAR(cause.size.value, -10, 1.5) << runs;
    EXPECT_NEAR(100 * cause.fitted.numbers.front(), cause.size.value, 0.1) << runs;
    const double before_mm = mean_at_full_pressure(later) / 0.9;
    EXPECT_NEAR(cause.full_pressure_mm, 0.01 * cause.size.value * before_mm, 0.03 * before_mm) << runs;
    EXPECT_NEAR(d->readings.back().gain_percent, 0, 0.1) << runs;
  }
}

TEST(Change, ACoarserLaterLogIsComparedWithEquallyCoarseHealthyLogs) {
  const std::vector<Log> healthy = healthy_with_varied_gain(3);
  const auto same = diagnose_change(healthy, {thinned_log(log_of({}, 5), 5)});
  ASSERT_TRUE(same) << same.error();
  EXPECT_EQ(same->verdict, ChangeVerdict::unchanged) << change_sentence(*same);
  EXPECT_GT(same->readings.back().loss_left, 0.1);
  const auto less = diagnose_change(healthy, {thinned_log(log_of({.gain = 0.2 * 0.8}, 5), 5)});
  ASSERT_TRUE(less) << less.error();
  ASSERT_FALSE(less->causes.empty()) << change_sentence(*less);
  EXPECT_EQ(less->causes.front().id, "ageing");
  EXPECT_NEAR(less->causes.front().size.value, -20, 2);
}

/// Adds a displacement that jumps between two values at random times. No cause of the library explains it.
Log with_random_jumps(Log log, double by_mm) {
  std::mt19937 random(3);
  std::exponential_distribution<double> pause_s(0.5);
  double next_s = pause_s(random), added_mm = by_mm;
  for (std::size_t i = 0; i < log.size(); ++i) {
    for (; log.time_s[i] > next_s; next_s += pause_s(random)) added_mm = -added_mm;
    log.displacement_mm[i] += added_mm;
  }
  return log;
}

TEST(Change, WarnsOfALogThatWasRecordedInAClosedLoop) {
  std::vector<Log> later{log_of({}, 5)};
  std::mt19937 random(4);
  std::normal_distribution<double> noise_mm(0, 0.02);
  for (std::size_t i = 0; i < later.front().size(); ++i) {
    const double error_mm = noise_mm(random);
    later.front().displacement_mm[i] += error_mm;
    later.front().pressure_command_kpa[i] -= error_mm;  // a controller with 1 kPa/mm
  }
  const auto warnings_of = [](const std::vector<Log>& logs) {
    std::string all;
    const auto diagnosis = diagnose_change({log_of({}, 1)}, logs);
    EXPECT_TRUE(diagnosis) << diagnosis.error();
    for (const std::string& warning : diagnosis->warnings) all += warning;
    return all;
  };
  EXPECT_NE(warnings_of(later).find("(closed loop) in log5."), std::string::npos);
  EXPECT_EQ(warnings_of({log_of({}, 5)}).find("closed loop"), std::string::npos);
}

TEST(Change, AnErrorInOneOfThreeLaterLogsIsNoChange) {
  const std::vector<Log> healthy{log_of({}, 1), log_of({}, 2), log_of({}, 3)};
  std::vector<Log> later{log_of({}, 5), with_random_jumps(log_of({}, 6), 0.3), log_of({}, 7)};
  const auto one = diagnose_change(healthy, later);
  ASSERT_TRUE(one) << one.error();
  EXPECT_EQ(one->readings.back().unusual_log, "log6");
  EXPECT_GT(one->readings.back().later_mm, one->readings.back().allowed_mm);
  EXPECT_EQ(one->verdict, ChangeVerdict::unchanged);
  EXPECT_EQ(change_sentence(*one).find("Unchanged: only log6 differs"), 0U) << change_sentence(*one);
  EXPECT_TRUE(std::any_of(one->warnings.begin(), one->warnings.end(), [](const std::string& warning) {
    return warning.find("Record log6 again") != std::string::npos;
  }));

  later[2] = with_random_jumps(later[2], 0.3);
  const auto two = diagnose_change(healthy, later);
  ASSERT_TRUE(two) << two.error();
  EXPECT_EQ(two->verdict, ChangeVerdict::unexplained) << change_sentence(*two);
  EXPECT_EQ(two->readings.back().unusual_log, "");
}

}  // namespace
}  // namespace softgrip::sysid::change_test
