#include "sysid/evidence/veto.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace softgrip::sysid::veto_test {
namespace {

/// Returns the evidence for a cause that meets all conditions for being reported.
Claim sound() {
  return {.size = Interval{1, 2}, .largest_size = 10, .error_without = 1, .error_with = 0.5};
}

TEST(Veto, ClaimThatMeetsAllConditionsIsAccepted) {
  EXPECT_EQ(veto_of(sound()), Veto::none);
  EXPECT_TRUE(reason_of(Veto::none).empty());
}

TEST(Veto, EachUnmetConditionRejectsTheClaim) {
  Claim claim = sound();
  claim.size = Interval{-0.02, 0.10};
  EXPECT_EQ(veto_of(claim), Veto::size_uncertain);
  claim.size = Interval{-29, -27};
  EXPECT_EQ(veto_of(claim), Veto::size_beyond_range);
  claim.size = Interval{8, 12};
  EXPECT_EQ(veto_of(claim), Veto::none)
      << "a size whose interval overlaps the range of the signal must be accepted";
  claim.size.reset();
  EXPECT_EQ(veto_of(claim), Veto::none);
  claim = sound();
  claim.keeps_other_sizes = false;
  EXPECT_EQ(veto_of(claim), Veto::other_size_uncertain);
  claim = sound();
  claim.error_with = 1.03;
  EXPECT_EQ(veto_of(claim), Veto::error_not_reduced);
  claim = sound();
  claim.explained_share = 0.19;
  EXPECT_EQ(veto_of(claim), Veto::explains_too_little);
  claim.explained_share = 0.2;
  EXPECT_EQ(veto_of(claim), Veto::none);
  claim = sound();
  claim.predicts_worse = true;
  EXPECT_EQ(veto_of(claim), Veto::not_predictive);
  claim = sound();
  claim.condition_met = false;
  EXPECT_EQ(veto_of(claim), Veto::not_tested);
  claim = sound();
  claim.shown_there = false;
  EXPECT_EQ(veto_of(claim), Veto::absent_where_required);
}

TEST(Veto, LargestSizeIsTheRangeOfTheSignalWithItsUnit) {
  const CampaignSize range{.largest_kpa = 60, .span_mm = 20, .longest_s = 30};
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(largest_possible_size(range, "kPa", 0), 60);
  EXPECT_EQ(largest_possible_size(range, "mm", 0), 20);
  EXPECT_EQ(largest_possible_size(range, "s", 0), 30);
  EXPECT_EQ(largest_possible_size(range, "%", 0), infinity);
  EXPECT_EQ(largest_possible_size(range, "mm", 1e4), infinity) << "a limit such as a saturation";
}

TEST(Veto, UnchangedErrorIsRejectedAsNotReduced) {
  Claim claim = sound();
  claim.error_with = claim.error_without;
  EXPECT_EQ(veto_of(claim), Veto::error_not_reduced);
}

TEST(Veto, EachVetoHasADistinctReason) {
  std::set<std::string_view> reasons;
  for (const Veto veto :
       {Veto::size_uncertain, Veto::size_beyond_range, Veto::other_size_uncertain, Veto::error_not_reduced,
        Veto::explains_too_little, Veto::not_predictive, Veto::not_tested, Veto::absent_where_required})
    EXPECT_TRUE(reasons.insert(reason_of(veto)).second);
}

}  // namespace
}  // namespace softgrip::sysid::veto_test
