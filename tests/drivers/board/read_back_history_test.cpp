#include "drivers/board/read_back_history.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace softgrip::drivers::read_back_history_test {
namespace {

ReadBack rules(double tolerance_raw, std::uint32_t lag_exchanges) {
  return {.registers = {}, .tolerance_raw = tolerance_raw, .lag_exchanges = lag_exchanges};
}

TEST(ReadBackHistory, AcceptsOnlyTheNewestValueWithoutLag) {
  ReadBackHistory history(rules(1, 0), 2);
  history.note(std::array{100.0, 200.0});
  EXPECT_TRUE(history.accepts(0, 101));
  EXPECT_FALSE(history.accepts(0, 102));
  EXPECT_FALSE(history.accepts(0, 200));
  EXPECT_TRUE(history.accepts(1, 199));
  history.note(std::array{300.0, 200.0});
  EXPECT_FALSE(history.accepts(0, 100));
}

TEST(ReadBackHistory, AcceptsEarlierValuesWithinTheLag) {
  ReadBackHistory history(rules(0, 2), 1);
  for (const double raw : {1.0, 2.0, 3.0, 4.0}) history.note(std::array{raw});
  EXPECT_FALSE(history.accepts(0, 1));
  for (const double raw : {2.0, 3.0, 4.0}) EXPECT_TRUE(history.accepts(0, raw));
}

TEST(ReadBackHistory, AcceptsAnyValueWithinTheLagOfANewSession) {
  ReadBackHistory history(rules(0, 1), 1);
  for (int session = 0; session < 2; ++session) {
    history.note(std::array{5.0});
    EXPECT_TRUE(history.accepts(0, 77));
    history.note(std::array{6.0});
    EXPECT_FALSE(history.accepts(0, 77));
    EXPECT_TRUE(history.accepts(0, 5));
    history.forget();
  }
}

TEST(ReadBackHistory, NeverAcceptsNaNAsReadBack) {
  ReadBackHistory history(rules(1e9, 1), 1);
  for (int i = 0; i < 3; ++i) {
    history.note(std::array{5.0});
    EXPECT_FALSE(history.accepts(0, std::numeric_limits<double>::quiet_NaN()));
  }
}

}  // namespace
}  // namespace softgrip::drivers::read_back_history_test
