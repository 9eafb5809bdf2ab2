#include "sysid/logs/plausibility_warnings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/numbers.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::plausibility_warnings_test {
namespace {

std::string all_of(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += warning + "\n";
  return text;
}

TEST(PlausibilityWarnings, WrongSignScaleOrOrderIsReported) {
  Log log;
  for (int i = 0; i < 400; ++i) {
    const double p = 30 - std::abs(i % 100 - 50) * 0.6;
    log.time_s.push_back(0.01 * i);
    log.pressure_command_kpa.push_back(p);
    log.pressure_kpa.push_back(p + 0.01 * (i % 3));
    log.displacement_mm.push_back(0.2 * p);
  }
  EXPECT_TRUE(plausibility_warnings(log).empty());
  const auto first_warning = [&](auto change) {
    Log other = log;
    for (std::size_t i = 0; i < other.size(); ++i) change(other, i);
    const auto warnings = plausibility_warnings(other);
    return warnings.empty() ? std::string() : warnings.front();
  };
  EXPECT_NE(
      first_warning([](Log& l, std::size_t i) { l.displacement_mm[i] *= -1; }).find("the reading decreases"),
      std::string::npos);
  EXPECT_NE(first_warning([](Log& l, std::size_t i) { l.pressure_kpa[i] /= 6.894757; }).find("psi and kPa"),
            std::string::npos);
  EXPECT_NE(first_warning([](Log& l, std::size_t i) { l.displacement_mm[i] /= 1000; }).find("metres"),
            std::string::npos);
  EXPECT_NE(first_warning([](Log& l, std::size_t i) {
              l.pressure_command_kpa[i] += 101;
              l.pressure_kpa[i] += 101;
            }).find("absolute"),
            std::string::npos);
  EXPECT_NE(first_warning([&](Log& l, std::size_t i) {
              l.pressure_kpa[i] = log.pressure_kpa[std::min<std::size_t>(i + 5, 399)];
            }).find("swapped"),
            std::string::npos);
}

/// Tests logs with a positive pressure and logs with a vacuum. Each log is recorded in every unit whose
/// values differ strongly from those in kPa.
TEST(PlausibilityWarnings, ImplausiblePressureOrLengthUnitIsNamed) {
  const auto warnings = [](double peak, double mm) {
    Log log;
    for (int i = 0; i < 400; ++i) {
      const double share = 1 - std::abs(i % 100 - 50) / 50.0;
      log.time_s.push_back(0.01 * i);
      log.pressure_command_kpa.push_back(peak * share);
      log.displacement_mm.push_back(mm * share);
    }
    return all_of(plausibility_warnings(log));
  };
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(warnings(sign * 60, sign * 20), "") << sign;
    EXPECT_NE(warnings(sign * 0.06, sign * 20).find("MPa, bar or V"), std::string::npos) << sign;
    EXPECT_NE(warnings(sign * 0.6, sign * 20).find("kPa: check if the values are in bar or V"),
              std::string::npos)
        << sign;
    EXPECT_NE(warnings(sign * 60e3, sign * 20).find("Pa or mbar"), std::string::npos) << sign;
    EXPECT_NE(warnings(sign * 8.7, sign * 20).find("moves by 2.3 mm per kPa: check if the values are in psi"),
              std::string::npos)
        << warnings(sign * 8.7, sign * 20);
    EXPECT_EQ(warnings(sign * 8.7, sign * 4), "")
        << "a log may use only a part of the pressure range, and its displacement per kPa is typical";
    EXPECT_NE(warnings(sign * 60, sign * 0.02).find("metres"), std::string::npos) << sign;
    EXPECT_NE(warnings(sign * 60, sign * 20e3).find("micrometres"), std::string::npos) << sign;
  }
}

/// The warning must state the largest value of the column and the reason why the unit is probably wrong.
TEST(PlausibilityWarnings, UnitWarningStatesColumnAndOption) {
  Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7);
  const std::vector<double> kpa = log.pressure_command_kpa;
  for (const auto& [unit, factor] :
       {std::pair{"psi", 6.894757}, {"bar", 100.0}, {"MPa", 1e3}, {"Pa", 1e-3}}) {
    for (std::size_t i = 0; i < kpa.size(); ++i) log.pressure_command_kpa[i] = kpa[i] / factor;
    const std::string warnings = all_of(plausibility_warnings(log, {"P set", "pressure"}));
    EXPECT_NE(warnings.find("The largest value of `P set` is "), std::string::npos) << unit << warnings;
    EXPECT_NE(warnings.find("--unit pressure=" + std::string(unit) + "`"), std::string::npos) << warnings;
  }
}

/// Every warning about the unit of a length, an angle, a temperature or a time must state the option and the
/// header that correct the unit.
TEST(PlausibilityWarnings, EachWarningAboutAUnitStatesTheOption) {
  const Log good = simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0, 7);
  const auto warnings = [&](auto change) {
    Log log = good;
    change(log);
    return all_of(plausibility_warnings(log));
  };
  const auto scaled = [](std::vector<double>& values, double factor) {
    for (double& value : values) value *= factor;
  };
  const std::vector<std::pair<std::string, std::string>> cases{
      {"displacement=m", warnings([&](Log& log) { scaled(log.displacement_mm, 1e-3); })},
      {"displacement=um", warnings([&](Log& log) { scaled(log.displacement_mm, 1e3); })},
      {"displacement=rad", warnings([&](Log& log) {
         log.output_unit = model::OutputUnit::deg;
         scaled(log.displacement_mm, 1.0 / 57);
       })},
      {"displacement=deg", warnings([&](Log& log) {
         log.output_unit = model::OutputUnit::deg;
         scaled(log.displacement_mm, 57);
       })},
      {"temperature=K", warnings([](Log& log) { log.temperature_c.assign(log.size(), 293); })},
      {"time=ms", warnings([&](Log& log) { scaled(log.time_s, 1e3); })},
      {"time=h", warnings([&](Log& log) { scaled(log.time_s, 1.0 / 3600); })}};
  for (const auto& [setting, text] : cases) {
    const std::string unit = setting.substr(setting.find('=') + 1);
    EXPECT_NE(text.find("`softgrip import --unit " + setting + "`, or `(" + unit + ")` in the header"),
              std::string::npos)
        << setting << ": " << text;
  }
}

TEST(PlausibilityWarnings, CorrectLogsGiveNoWarning) {
  for (const char* name : {"bench_twin", "zhang2025"}) {
    std::vector<Log> logs;
    for (const auto signal :
         {model::SignalName::tp1, model::SignalName::sp2, model::SignalName::steps, model::SignalName::hold})
      logs.push_back(simulated(loaded(name), signal, 20, 0.05, 7));
    EXPECT_EQ(all_of(plausibility_warnings_among(logs)), "") << name;
  }
}

TEST(PlausibilityWarnings, SingleWrongCommandIsReportedWithTimeAndValue) {
  Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 20, 0.05, 7);
  const std::size_t at = log.size() / 2;
  log.pressure_command_kpa[at] = 999;
  const std::string warnings = all_of(plausibility_warnings(log));
  EXPECT_NE(warnings.find("1 single sample has a command outside the range of all other samples"),
            std::string::npos)
      << warnings;
  EXPECT_NE(warnings.find("999 kPa at " + significant(log.time_s[at], 6) + " s"), std::string::npos)
      << warnings;
}

TEST(PlausibilityWarnings, ReversedReadingsNameTheSignThatIsNeeded) {
  Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7);
  for (double& y : log.displacement_mm) y *= -1;
  EXPECT_NE(all_of(plausibility_warnings(log)).find("with a negative factor"), std::string::npos);
  const std::string reversed = all_of(plausibility_warnings(log, {}, ReadingSign::reversed));
  EXPECT_NE(reversed.find("Use the opposite sign"), std::string::npos) << reversed;
  EXPECT_EQ(reversed.find("with a negative factor"), std::string::npos) << reversed;
}

/// A log whose pressure is clearly in a wrong unit must not cause a warning about a correct log.
TEST(PlausibilityWarnings, ACorrectLogIsNotBlamedForTheUnitOfAnotherLog) {
  std::vector<Log> logs(2, simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7));
  logs[0].name = "good", logs[1].name = "psi";
  for (double& p : logs[1].pressure_command_kpa) p /= 6.894757;
  for (Log& log : logs) {
    for (double& y : log.displacement_mm) y *= 3;
  }
  const std::string warnings = all_of(plausibility_warnings_among(logs));
  EXPECT_EQ(warnings.find("good: "), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("psi: the finger moves 6.89 times as far per kPa as in the other logs"),
            std::string::npos)
      << warnings;
}

TEST(PlausibilityWarnings, AWarningAboutTheUnitIsNotRepeatedInTheNotesOfTheLog) {
  Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0, 7);
  for (double& y : log.displacement_mm) y /= 1000;
  for (double& p : log.pressure_command_kpa) p /= 1000;
  document::Problems problems;
  const auto read = parse_log("a.csv", format_log(log), problems);
  ASSERT_TRUE(read) << problems.format();
  EXPECT_TRUE(read->notes.empty()) << read->notes.front().text;
  const std::string warnings = all_of(plausibility_warnings(*read));
  EXPECT_NE(warnings.find("metres"), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("MPa"), std::string::npos) << warnings;
}

TEST(PlausibilityWarnings, SwappedColumnsAreReported) {
  for (const auto signal : {model::SignalName::tp1, model::SignalName::steps, model::SignalName::hold}) {
    Log log = simulated(loaded("bench_twin"), signal, 50, 0.05, 7);
    std::swap(log.pressure_command_kpa, log.displacement_mm);
    EXPECT_NE(all_of(plausibility_warnings(log)).find("swapped"), std::string::npos) << log.name;
  }
}

TEST(PlausibilityWarnings, HoldingAPartIsReported) {
  Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7);
  log.others.push_back({"result", std::vector<std::string>(log.size(), "none")});
  EXPECT_TRUE(plausibility_warnings(log).empty());
  std::fill_n(log.others[0].cells.begin() + 100, log.size() / 4, "holding");
  EXPECT_NE(all_of(plausibility_warnings(log)).find("holds a part in 25 % of the rows"), std::string::npos)
      << all_of(plausibility_warnings(log));
}

TEST(PlausibilityWarnings, LogInADifferentUnitIsReported) {
  std::vector<Log> logs(3, simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7));
  logs[0].name = "a", logs[1].name = "b", logs[2].name = "c";
  for (double& y : logs[1].displacement_mm) y /= 25.4;
  const std::string warnings = all_of(plausibility_warnings_among(logs));
  EXPECT_NE(warnings.find("b: the finger moves 0.0394 times as far per kPa as in the other logs. Possible "
                          "cause: the displacement column in inch"),
            std::string::npos)
      << warnings;
  EXPECT_EQ(warnings.find("a: "), std::string::npos);
}

TEST(PlausibilityWarnings, DuplicateLogIsReported) {
  std::vector<Log> logs(2, simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7));
  logs[0].name = "a", logs[1].name = "b";
  logs[0].displacement_mm[3] = logs[1].displacement_mm[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(all_of(plausibility_warnings_among(logs)),
            "b: the log contains the same samples as a. Repeated samples make the confidence intervals too "
            "narrow\n");
  EXPECT_EQ(all_of(plausibility_warnings_among(logs, "They count twice")),
            "b: the log contains the same samples as a. They count twice\n");
  EXPECT_EQ(all_of(repetition_warnings({logs[1]}, {logs[0]}, "the healthy log", "No change is visible")),
            "b: the log contains the same samples as the healthy log a. No change is visible\n");
  logs[1].displacement_mm[4] += 0.001;
  EXPECT_EQ(all_of(repetition_warnings({logs[1]}, {logs[0]}, "the healthy log", "No change is visible")), "");
  EXPECT_EQ(all_of(plausibility_warnings_among(logs)), "");
}

TEST(PlausibilityWarnings, CorrectedValuesAreReported) {
  Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7);
  log.name = "a";
  log.notes = {{2, "a reading was removed", true}, {3, "a gap", false}};
  EXPECT_EQ(all_of(plausibility_warnings_among({log})), "a: a reading was removed\n");
}

TEST(PlausibilityWarnings, ReadingsScaledAgainstTheModelAreReported) {
  const Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7);
  std::vector<double> predicted = log.displacement_mm;
  EXPECT_EQ(scale_warning("x", predicted, log.displacement_mm, log.output_unit), "");
  for (double& y : predicted) y /= 6.5;
  EXPECT_NE(scale_warning("x", predicted, log.displacement_mm, log.output_unit)
                .find("x: the readings are 6.5 times"),
            std::string::npos);
  for (const double factor : {2.0, 57.3, -1.5}) {
    std::vector<double> scaled = log.displacement_mm;
    for (double& y : scaled) y /= factor;
    const std::string sentence = scale_warning("x", scaled, log.displacement_mm, log.output_unit);
    EXPECT_EQ(sentence.find("belong to the same finger") != std::string::npos, factor > 3) << sentence;
  }
}

}  // namespace
}  // namespace softgrip::sysid::plausibility_warnings_test
