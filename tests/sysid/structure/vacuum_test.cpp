#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "sysid/structure/identify_structure.h"

namespace softgrip::sysid::vacuum_test {
namespace {

/// Returns a log with triangles of the pressure between 0 and `peak_kpa`.
Log log_up_to(double peak_kpa) {
  Log log;
  log.name = "log";
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.02);
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.02 * i, share = std::max(0.0, 1 - std::abs(std::fmod(t, 10) - 5) / 4);
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(peak_kpa * share);
    log.displacement_mm.push_back(0.2 * peak_kpa * share + noise(random));
  }
  return log;
}

TEST(IdentifyStructure, VacuumIsReported) {
  const auto warns_of_vacuum = [](const Log& log) {
    const auto found = identify_structure({log}, StructureQuestion::bouc_wen);
    EXPECT_TRUE(found) << found.error();
    return found && std::any_of(found->warnings.begin(), found->warnings.end(), [](const std::string& w) {
             return w.find("only for positive pressures") != std::string::npos;
           });
  };
  EXPECT_TRUE(warns_of_vacuum(log_up_to(-50)));
  EXPECT_FALSE(warns_of_vacuum(log_up_to(50)));
}

}  // namespace
}  // namespace softgrip::sysid::vacuum_test
