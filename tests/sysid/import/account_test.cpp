#include "sysid/import/account.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::account_test {
namespace {

TEST(RowAccount, IsBalancedOnlyIfEveryRowIsAccountedFor) {
  RowAccount account;
  account.rows = 10;
  account.used = 6;
  account.joined = 1;
  account.leave_out(LeftOut::hole, 2);
  EXPECT_FALSE(account.balanced());
  account.leave_out(LeftOut::no_time);
  EXPECT_TRUE(account.balanced());
  EXPECT_EQ(
      account.sentence(),
      "10 rows: 6 used, 1 merged with another row that has the same time, 3 left out (1 without a time, 2 in "
      "shorter segments before or after a gap)");
}

TEST(RowAccount, RowsExcludedByTheUserAreNotLost) {
  RowAccount account;
  account.rows = 100;
  account.used = 30;
  account.leave_out(LeftOut::other_channel, 50);
  account.leave_out(LeftOut::outside_stretch, 10);
  EXPECT_EQ(account.lost_share(), 0);
  account.leave_out(LeftOut::repeated_time, 10);
  EXPECT_EQ(account.lost(), 10U);
  EXPECT_EQ(account.lost_share(), 0.25);
}

TEST(RowAccount, EachReasonHasADistinctWord) {
  for (std::size_t i = 0; i < left_out_count; ++i) {
    EXPECT_FALSE(word_of(static_cast<LeftOut>(i)).empty());
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_NE(word_of(static_cast<LeftOut>(i)), word_of(static_cast<LeftOut>(j)));
  }
}

}  // namespace
}  // namespace softgrip::sysid::account_test
