#include "sysid/instrument/identified_logs.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/sysid/simulated.h"

namespace softgrip::sysid::identified_logs_test {
namespace {

/// Returns a log of bench_twin. One reading of the log is 20 mm too large.
Log with_an_outlier(std::uint64_t seed) {
  Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 20, 0.05, seed);
  log.name = "log " + std::to_string(seed);
  log.displacement_mm[100] += 20;
  return log;
}

IdentifyQuestion question() {
  IdentifyQuestion all;
  all.logs = {with_an_outlier(1)};
  all.start = loaded("bench_twin");
  all.options.starts = 1;
  return all;
}

TEST(IdentifiedLogs, OutlierIsNotFittedAndIsTheFirstWarning) {
  const auto all = identify_logs(question());
  ASSERT_TRUE(all) << all.error();
  EXPECT_TRUE(std::isnan(all->logs.front().displacement_mm[100]));
  EXPECT_LT(all->result.rmse_mm, 0.06);
  ASSERT_FALSE(all->result.warnings.empty());
  EXPECT_NE(all->result.warnings.front().find("log 1"), std::string::npos) << all->result.warnings.front();
  EXPECT_EQ(all->result.model.name, "bench_twin_identified");
  EXPECT_NE(all->result.model.source.find("log 1"), std::string::npos);
}

TEST(IdentifiedLogs, ValidationLogsAreCleanedAndPredicted) {
  IdentifyQuestion asked = question();
  asked.validation = {with_an_outlier(2)};
  const auto all = identify_logs(std::move(asked));
  ASSERT_TRUE(all) << all.error();
  ASSERT_EQ(all->validation.size(), 1U);
  EXPECT_LT(all->validation.front().rmse_mm, 0.1);
  const auto& warnings = all->result.warnings;
  EXPECT_EQ(std::count_if(warnings.begin(), warnings.begin() + 2,
                          [](const std::string& text) { return text.find("log ") != std::string::npos; }),
            2);
  EXPECT_EQ(all->report({}).validation_logs, &all->validation_logs);
}

TEST(IdentifiedLogs, ValidationOnAFittedLogIsReported) {
  IdentifyQuestion asked = question();
  asked.validation = asked.logs;
  const auto all = identify_logs(std::move(asked));
  ASSERT_TRUE(all) << all.error();
  const std::string sentence =
      "log 1: the log contains the same samples as the fitted log log 1. The error on this log is therefore "
      "not an error on new data";
  EXPECT_EQ(std::ranges::count(all->result.warnings, sentence), 1);
}

TEST(IdentifiedLogs, BaseStructureIsUsedWithoutAStartModel) {
  IdentifyQuestion asked = question();
  asked.start.reset();
  asked.branches = 1;
  asked.options.starts = 2;
  const auto all = identify_logs(std::move(asked));
  ASSERT_TRUE(all) << all.error();
  EXPECT_EQ(all->start.name, "base structure, with start values from the scale of the data");
  EXPECT_EQ(all->report({}).validation_logs, nullptr);
}

TEST(IdentifiedLogs, ARefusalNamesTheParameter) {
  IdentifyQuestion asked = question();
  asked.options.fixed = {"no.such"};
  const auto all = identify_logs(std::move(asked));
  ASSERT_FALSE(all);
  EXPECT_NE(all.error().find("no.such"), std::string::npos) << all.error();
}

TEST(ValidateGivenLogs, PredictsWithoutTheWrongReadings) {
  std::vector<Log> logs{with_an_outlier(3)};
  const Validation validation = validate_given_logs(loaded("bench_twin"), logs, {});
  EXPECT_TRUE(std::isnan(logs.front().displacement_mm[100]));
  EXPECT_LT(validation.scores.front().rmse_mm, 0.06);
  ASSERT_FALSE(validation.warnings.empty());
}

Estimate estimate(const std::string& name, bool free) {
  Estimate one;
  one.name = name;
  one.free = free;
  return one;
}

TEST(ExcitationLimits, NameTheFreeParametersWithoutExcitation) {
  Log ramp;
  for (int i = 0; i < 500; ++i) {
    ramp.time_s.push_back(0.02 * i);
    ramp.pressure_command_kpa.push_back(i < 200 ? 0 : 0.1 * (i - 200));
    ramp.displacement_mm.push_back(0);
  }
  const std::vector<Estimate> parameters{
      estimate("bouc_wen.alpha_mm_per_kpa", true), estimate("bouc_wen.beta_mm_per_kpa", true),
      estimate("bouc_wen.gamma_per_kpa", false), estimate("kelvin_voigt.k1_kpa_per_mm", true)};
  EXPECT_EQ(
      excitation_limits({ramp}, parameters),
      std::vector<std::string>{
          "the logs contain no unloading (decrease of the pressure), so hysteresis cannot be determined; the "
          "following parameters require the missing excitation: "
          "bouc_wen.beta_mm_per_kpa"});
  for (double& kpa : ramp.pressure_command_kpa) kpa += 1;
  const std::vector<std::string> both = excitation_limits({ramp}, parameters);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NE(both[1].find("require the missing excitation: kelvin_voigt.k1_kpa_per_mm"), std::string::npos)
      << both[1];
}

}  // namespace

}  // namespace softgrip::sysid::identified_logs_test
