#include "sysid/structure/valve_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>

namespace softgrip::sysid::valve_stage_test {
namespace {

/// A valve with one lag, and a log of its pressure.
struct Case {
  double lag_s, length_s, interval_s;
};

/// Returns a log with ramps, steps and holds of the command. Their durations are shares of the log.
Log log_of(const Case& c) {
  constexpr std::array<std::array<double, 2>, 12> corners{{{0, 0},
                                                           {0.06, 0},
                                                           {0.1, 50},
                                                           {0.15, 0},
                                                           {0.28, 60},
                                                           {0.37, 60},
                                                           {0.4, 20},
                                                           {0.47, 0},
                                                           {0.57, 45},
                                                           {0.65, 45},
                                                           {0.66, 15},
                                                           {1, 15}}};
  Log log;
  log.name = "log";
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.1);
  const auto n = static_cast<int>(c.length_s / c.interval_s);
  double p = 0, last = 0;
  for (int i = 0; i < n; ++i) {
    const double share = static_cast<double>(i) / n;
    const auto* after = std::find_if(corners.begin(), corners.end() - 1,
                                     [&](const auto& corner) { return corner[0] > share; });
    const auto& [from, to] = std::pair(*(after - 1), *after);
    const double u = from[1] + (to[1] - from[1]) * (share - from[0]) / (to[0] - from[0]);
    p += (last - p) * (1 - std::exp(-c.interval_s / c.lag_s));
    last = u;
    log.time_s.push_back(i * c.interval_s);
    log.pressure_command_kpa.push_back(u);
    log.displacement_mm.push_back(0);
    log.pressure_kpa.push_back(p + noise(random));
  }
  return log;
}

TEST(ValveStage, SlowAndFastValvesAreFound) {
  for (const Case& c : {Case{15, 1200, 0.1}, Case{25, 1200, 0.1}, Case{0.1, 60, 0.02}, Case{0.004, 3, 5e-4},
                        Case{0.0015, 3, 5e-4}, Case{4e-4, 0.3, 5e-5}}) {
    const ValveStage stage = fit_valve_stage({log_of(c)}, 1, false);
    EXPECT_NEAR(stage.filling_s, c.lag_s, 0.1 * c.lag_s) << c.lag_s << " s";
    EXPECT_NEAR(stage.venting_s, c.lag_s, 0.1 * c.lag_s) << c.lag_s << " s";
    EXPECT_LT(stage.delay_s, c.interval_s) << c.lag_s << " s";
    EXPECT_LT(stage.rmse_percent, 0.5) << c.lag_s << " s";
    EXPECT_TRUE(stage.limits_reached.empty()) << c.lag_s << " s";
  }
}

TEST(ValveStage, TimeAtItsLimitIsReported) {
  const ValveStage stage = fit_valve_stage({log_of({600, 60, 0.02})}, 1, false);
  ASSERT_FALSE(stage.limits_reached.empty());
  EXPECT_EQ(stage.limits_reached.front(), "dead time of 15 s") << "25 % of the log";
}

}  // namespace
}  // namespace softgrip::sysid::valve_stage_test
