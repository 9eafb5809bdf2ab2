#include "sysid/diagnosis/residual/closed_loop.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace softgrip::sysid::closed_loop_test {
namespace {

struct Signals {
  std::vector<double> command, reading;
};

/// Returns the signals of an integrating controller that keeps a reading at 0.
Signals integrated(std::size_t samples) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.01);
  Signals s;
  double moved = 0.3, command = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    s.reading.push_back(moved + noise(random));
    command -= 0.05 * s.reading.back();
    s.command.push_back(command);
    moved += 0.5 * (command - moved);
  }
  return s;
}

/// If the sampling interval is long, the command depends on the reading of the same sample only.
TEST(ClosedLoop, AnImmediateFeedbackIsAClosedLoopAndAnImmediateResponseIsNot) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  Signals fed_back, responding;
  for (int i = 0; i < 1000; ++i) {
    fed_back.reading.push_back(normal(random));
    fed_back.command.push_back(-0.5 * fed_back.reading.back() + normal(random));
    responding.command.push_back(normal(random));
    responding.reading.push_back(0.5 * responding.command.back() + normal(random));
  }
  EXPECT_TRUE(is_closed_loop(fed_back.command, fed_back.reading));
  EXPECT_FALSE(is_closed_loop(responding.command, responding.reading));
}

TEST(ClosedLoop, GapsAreSkippedAndShortOrConstantSeriesAreNotTested) {
  Signals s = integrated(600);
  for (std::size_t i = 0; i < s.reading.size(); i += 7)
    s.reading[i] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_closed_loop(s.command, s.reading));
  EXPECT_FALSE(is_closed_loop(std::vector<double>(s.reading.size(), 2), s.reading));
  EXPECT_FALSE(is_closed_loop({}, {}));
  const Signals few = integrated(52);
  EXPECT_FALSE(is_closed_loop(few.command, few.reading));
}

}  // namespace
}  // namespace softgrip::sysid::closed_loop_test
