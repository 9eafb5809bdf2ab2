#include "sysid/changes/orientation.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sysid/changes/change.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::orientation_test {
namespace {

struct Signs {
  double pressure, reading;
};
constexpr Signs all_signs[] = {{1, 1}, {1, -1}, {-1, 1}, {-1, -1}};

std::vector<Log> mirrored(std::vector<Log> logs, const Signs& signs) {
  for (Log& log : logs) {
    for (double& kpa : log.pressure_command_kpa) kpa *= signs.pressure;
    for (double& kpa : log.pressure_kpa) kpa *= signs.pressure;
    for (double& mm : log.displacement_mm) mm *= signs.reading;
  }
  return logs;
}

TEST(Orientation, UndoesTheSignsOfTheRig) {
  const std::vector<Log> logs = test::logs_of({}, 1, true);
  for (const Signs& signs : all_signs) {
    const std::vector<Log> rig = mirrored(logs, signs);
    const Orientation orientation = orientation_of(rig);
    EXPECT_EQ(orientation.pressure, signs.pressure);
    EXPECT_EQ(orientation.reading, signs.reading);
    const std::vector<Log> back = oriented(rig, orientation);
    for (std::size_t k = 0; k < logs.size(); ++k) {
      EXPECT_EQ(back[k].displacement_mm, logs[k].displacement_mm);
      EXPECT_EQ(back[k].pressure_command_kpa, logs[k].pressure_command_kpa);
      EXPECT_EQ(back[k].pressure_kpa, logs[k].pressure_kpa);
    }
  }
}

TEST(Orientation, ReadingsThatDoNotFollowTheCommandAreKept) {
  Log log = test::log_of({}, 1);
  for (std::size_t i = 0; i < log.size(); ++i) log.displacement_mm[i] = i % 7 == 0 ? 1 : -1;
  EXPECT_FALSE(orientation_of({log}).is_mirrored());
  EXPECT_EQ(sentence_of({}), "");
}

/// Returns logs with the given zeros whose commands lie above each other, so that the readings fall from log
/// to log.
std::vector<Log> with_zeros(const std::vector<double>& zeros_mm, double kpa_per_log) {
  std::vector<Log> logs;
  for (const double zero_mm : zeros_mm) {
    logs.push_back(test::log_of({.zero_mm = zero_mm}, 1));
    for (double& kpa : logs.back().pressure_command_kpa)
      kpa += kpa_per_log * static_cast<double>(logs.size() - 1);
  }
  return logs;
}

TEST(Orientation, DoesNotDependOnTheZerosOfTheRuns) {
  EXPECT_FALSE(orientation_of(with_zeros({100, 50, 0}, 60)).is_mirrored());
  const Orientation reversed = orientation_of(mirrored(with_zeros({0, -200, -400}, 0), {1, -1}));
  EXPECT_EQ(reversed.pressure, 1);
  EXPECT_EQ(reversed.reading, -1);
}

TEST(Orientation, AMirroredRigHasTheSameCauses) {
  std::string unmirrored;
  for (const Signs& signs : all_signs) {
    const auto d = diagnose_change(mirrored(test::logs_of({}, 1), signs),
                                   mirrored(test::logs_of({.stop_mm = 8}, 5), signs), {});
    ASSERT_TRUE(d.has_value()) << d.error();
    ASSERT_FALSE(d->causes.empty()) << signs.pressure << ' ' << signs.reading;
    if (unmirrored.empty()) unmirrored = d->causes.front().id;
    EXPECT_EQ(d->causes.front().id, unmirrored) << signs.pressure << ' ' << signs.reading;
    const bool is_stated =
        !d->warnings.empty() && d->warnings.front().find("multiplied by -1") != std::string::npos;
    EXPECT_EQ(is_stated, signs.pressure < 0 || signs.reading < 0);
    EXPECT_EQ(d->orientation.pressure, signs.pressure);
    EXPECT_EQ(d->orientation.reading, signs.reading);
  }
  EXPECT_TRUE(unmirrored == "contact" || unmirrored == "sensor_saturation") << unmirrored;
}

}  // namespace
}  // namespace softgrip::sysid::orientation_test
