#include "sysid/diagnosis/verdict/another_base.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::sysid::another_base_test {
namespace {

constexpr double noise_mm = 0.04;

/// Returns a selection with one cause. The unexplained error is `before_mm` without the cause and `left_mm`
/// with the cause.
Selection left_of(double left_mm, double before_mm) {
  Selection selection;
  selection.left = {.excess_mm = left_mm, .present = true};
  selection.base_unexplained = {.excess_mm = before_mm, .present = true};
  return selection;
}

TEST(MayLackABase, IsFalseIfTheUnexplainedErrorIsSmall) {
  Selection nothing = left_of(2 * noise_mm, 3 * noise_mm);
  nothing.left.present = false;
  EXPECT_FALSE(may_lack_a_base(nothing, noise_mm));
  EXPECT_FALSE(may_lack_a_base(left_of(0.9 * worth_a_look * noise_mm, 0.01 * noise_mm), noise_mm));
}

TEST(MayLackABase, DependsOnTheRemainingShareOfTheError) {
  // The cause leaves 0.9 % of the mean square error. In simulated test cases, the cause "softening" leaves a
  // share of this size although it is the true cause.
  EXPECT_FALSE(may_lack_a_base(left_of(0.3 * noise_mm, 0.3 * noise_mm / std::sqrt(0.009)), noise_mm));
  // The cause leaves 10 % of the mean square error. A wrong cause leaves a share of this size if it only
  // imitates a loop of a different shape.
  EXPECT_TRUE(may_lack_a_base(left_of(0.3 * noise_mm, 0.3 * noise_mm / std::sqrt(0.1)), noise_mm));
}

TEST(MayLackABase, IsTrueIfTheRemainingErrorExceedsTheNoise) {
  EXPECT_TRUE(may_lack_a_base(left_of(1.1 * noise_mm, 1000 * noise_mm), noise_mm));
}

NamedCause named(std::string_view id) {
  NamedCause one;
  one.cause = *find_cause(id);
  return one;
}

TEST(AnotherShape, SufficesOnlyWithSimilarLossAndWithoutAsymmetry) {
  const BlockLosses selected(10, 0.04);
  BaseFindings base;
  base.named = {named("hysteresis_shape"), named("slow_creep")};
  base.losses.assign(10, 1.15 * 0.04);
  EXPECT_TRUE(another_shape_will_do(base, selected));
  base.losses.assign(10, 1.3 * 0.04);
  EXPECT_FALSE(another_shape_will_do(base, selected))
      << "the loss of the alternative structure is 30 % larger, so this structure does not suffice";
  base.losses = selected;
  base.named.push_back(named("asymmetric_hysteresis"));
  EXPECT_FALSE(another_shape_will_do(base, selected))
      << "the alternative structure also needs an asymmetric loop";
  base.named = {named("slow_creep")};
  EXPECT_FALSE(another_shape_will_do(base, selected))
      << "the alternative structure has no other shape of the hysteresis loops";
}

TEST(AnotherShape, IsAddedOnceAndOnlyToTheAsymmetricLoop) {
  std::vector<NamedCause> names{named("asymmetric_hysteresis"), named("contact")};
  add_another_shape(names);
  add_another_shape(names);
  ASSERT_EQ(names[0].alternatives.size(), 1U);
  EXPECT_EQ(names[0].alternatives[0].id, "hysteresis_shape");
  EXPECT_TRUE(names[1].alternatives.empty());
}

TEST(AnotherBase, AbsentAlternativeStructureResolvesNoSelection) {
  const SearchData data;
  AnotherBase another(data, {});
  EXPECT_FALSE(another.is_found());
  EXPECT_FALSE(another.settles(left_of(1000, 1000)));
  EXPECT_TRUE(std::isinf(another.mean_square_mm2()));
  another.go_on(left_of(1, 1));
  EXPECT_FALSE(another.is_found());
}

}  // namespace
}  // namespace softgrip::sysid::another_base_test
