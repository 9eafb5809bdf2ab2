#include "sysid/changes/change_judge.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::change_judge_test {
namespace {

class ChangeJudge : public test::PressureBase {
 protected:
  [[nodiscard]] ChangeDiagnosis judged(const test::Finger& later) const {
    ChangeDiagnosis diagnosis;
    const ChangeOptions options;
    judge_change(base_, true, pressure_records(test::logs_of(later, 5, true), false), options, diagnosis);
    return diagnosis;
  }
};

TEST_F(ChangeJudge, FindsNoCauseInAnotherHealthyRun) {
  const ChangeDiagnosis diagnosis = judged({});
  EXPECT_TRUE(diagnosis.causes.empty());
  ASSERT_EQ(diagnosis.readings.size(), 1U);
  EXPECT_EQ(diagnosis.readings.front().judged, Judged::pressure);
  EXPECT_FALSE(diagnosis.readings.front().left_over);
}

TEST_F(ChangeJudge, FindsADelay) {
  const ChangeDiagnosis diagnosis = judged({.delay_s = 0.06});
  ASSERT_EQ(diagnosis.causes.size(), 1U);
  EXPECT_EQ(diagnosis.causes.front().id, "transport_delay");
  EXPECT_EQ(diagnosis.causes.front().judged, Judged::pressure);
}

}  // namespace
}  // namespace softgrip::sysid::change_judge_test
