#include "control/elements/limit_watch.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace softgrip::control::limit_watch_test {
namespace {

constexpr double tick_s = 0.005;

/// Returns the names of the limits that the watch reports during `seconds`. The name "none" reports the end
/// of a limit. `binds(time)` returns the limit that is active at this time.
template <class Binds>
std::vector<std::string> told(double seconds, Binds&& binds) {
  LimitWatch watch;
  std::vector<std::string> all;
  for (double t = 0; t < seconds; t += tick_s) {
    if (const auto now = watch.observe(t, binds(t))) all.emplace_back(name_of(*now));
  }
  return all;
}

TEST(LimitWatch, ALimitActiveFor400MsIsNotReported) {
  EXPECT_TRUE(told(2, [](double t) {
                return t > 0.5 && t < 0.9 ? BindingLimit::rig_pressure : BindingLimit::none;
              }).empty());
}

TEST(LimitWatch, ALastingLimitIsReportedOnceAndClearedOnce) {
  const auto all =
      told(5, [](double t) { return t > 1 && t < 4 ? BindingLimit::step_squeeze : BindingLimit::none; });
  EXPECT_EQ(all, (std::vector<std::string>{"step_squeeze", "none"}));
}

TEST(LimitWatch, ALimitThatReplacesAnotherLimitIsReported) {
  const auto all = told(6, [](double t) {
    return t > 4 ? BindingLimit::none : t > 2 ? BindingLimit::rig_pressure : BindingLimit::rig_slew_up;
  });
  EXPECT_EQ(all, (std::vector<std::string>{"rig_slew_up", "rig_pressure", "none"}));
}

TEST(LimitWatch, TwoAlternatingLimitsAreReportedAsOneLimit) {
  int tick = 0;
  const auto all = told(5, [&](double t) {
    const BindingLimit one = ++tick % 2 == 0 ? BindingLimit::step_pressure : BindingLimit::step_squeeze;
    return t < 3 ? one : BindingLimit::none;
  });
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all.back(), "none");
}

TEST(LimitWatch, ALimitHasANameAndATextAndNoneHasNoText) {
  EXPECT_EQ(name_of(BindingLimit::rig_slew_down), "rig_slew_down");
  EXPECT_EQ(words_of(BindingLimit::rig_slew_up),
            "slew_up_kpa_per_s of the rig limits the rate of the pressure");
  EXPECT_TRUE(words_of(BindingLimit::none).empty());
}

TEST(LimitWatch, ALimitThatTogglesWithNoiseIsReportedOnce) {
  int tick = 0;
  const auto all = told(5, [&](double t) {
    return t < 3 && ++tick % 3 == 0 ? BindingLimit::step_pressure : BindingLimit::none;
  });
  EXPECT_EQ(all, (std::vector<std::string>{"step_pressure", "none"}));
}

}  // namespace
}  // namespace softgrip::control::limit_watch_test
