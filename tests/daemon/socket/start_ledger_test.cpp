#include "daemon/socket/start_ledger.h"

#include <gtest/gtest.h>

namespace softgrip::daemon::start_ledger_test {
namespace {

TEST(StartLedger, AStartIsFoundByRequestNumberAndByStartId) {
  StartLedger ledger;
  ledger.add({4, "a", 11}, 0);
  ledger.add({6, "", 12}, 4);
  EXPECT_EQ(ledger.request_of("a"), 4U);
  EXPECT_EQ(ledger.client_of(4), 11U);
  EXPECT_EQ(ledger.client_of(6), 12U);
  EXPECT_TRUE(ledger.has(6));
  EXPECT_FALSE(ledger.has(5));
  EXPECT_EQ(ledger.client_of(5), 0U);
  EXPECT_EQ(ledger.request_of("b"), std::nullopt);
  EXPECT_EQ(ledger.request_of(""), std::nullopt) << "a start without an id matches no other start";
}

TEST(StartLedger, AStartIdNamedByAnEarlierStopIsForbidden) {
  StartLedger ledger;
  EXPECT_FALSE(ledger.is_forbidden("a"));
  ledger.forbid("a");
  EXPECT_TRUE(ledger.is_forbidden("a"));
  EXPECT_FALSE(ledger.is_forbidden("")) << "a start without an id is always permitted";
}

TEST(StartLedger, TheOldestStartsAreRemovedExceptTheRunningOne) {
  StartLedger ledger;
  ledger.add({1, "runs", 7}, 0);
  for (std::uint32_t request = 2; request < 2000; ++request) {
    ledger.add({request, "id " + std::to_string(request), 8}, 1);
    ledger.forbid("gone " + std::to_string(request));
  }
  EXPECT_EQ(ledger.request_of("runs"), 1U);
  EXPECT_EQ(ledger.request_of("id 1999"), 1999U);
  EXPECT_EQ(ledger.request_of("id 2"), std::nullopt);
  EXPECT_TRUE(ledger.is_forbidden("gone 1999"));
  EXPECT_FALSE(ledger.is_forbidden("gone 2"));
}

}  // namespace
}  // namespace softgrip::daemon::start_ledger_test
