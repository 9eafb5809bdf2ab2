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
  return oriented(std::move(logs), {signs.pressure, signs.reading});
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
  }
  EXPECT_TRUE(unmirrored == "contact" || unmirrored == "sensor_saturation") << unmirrored;
}

}  // namespace
}  // namespace softgrip::sysid::orientation_test
