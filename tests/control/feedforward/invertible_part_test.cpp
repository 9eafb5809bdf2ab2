#include "control/feedforward/invertibility.h"

#include <gtest/gtest.h>

#include "model/blocks/relaxing_friction.h"
#include "model/named.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::invertible_part_test {
namespace {

using sim::model_named;

constexpr LimitSettings limits{0, 60, 400, 400, 0, 25, 1};

bool is_accepted(const model::Model& model) {
  return check_feedforward(model, {FeedforwardKind::full_model, 0}, limits, sim::tick_s).has_value();
}

TEST(InvertiblePart, AnInvertibleModelHasNoSeparatePart) {
  EXPECT_FALSE(invertible_part(model_named("bench_twin"), limits, sim::tick_s));
}

TEST(InvertiblePart, OnlyTheBlockWithoutAnInverseIsLeftOut) {
  const model::Model twin = model_named("bench_twin");
  const model::Model whole =
      model::with_block(twin, model::block_of<model::RelaxingFriction>(
                                  {{"gain_mm_per_kpa", 0.3}, {"width_kpa", 1.0}, {"time_constant_s", 0.08}}));
  ASSERT_FALSE(is_accepted(whole));
  const auto part = invertible_part(whole, limits, sim::tick_s);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->left_out, std::vector<std::string>{"relaxing_friction"});
  EXPECT_EQ(part->model.blocks, twin.blocks);
}

/// The published finger has creep with two branches and a hysteresis loop. The creep has an inverse; the
/// hysteresis loop has none.
TEST(InvertiblePart, LeavesBoucWenOutOfThePublishedModel) {
  const model::Model published = model_named("zhang2025");
  const auto part = invertible_part(published, limits, sim::tick_s);
  ASSERT_TRUE(part);
  EXPECT_TRUE(is_accepted(part->model));
  EXPECT_EQ(part->left_out, std::vector<std::string>{"bouc_wen"});
}

TEST(InvertiblePart, LeavesBoucWenOutOnAVacuumChannel) {
  const LimitSettings vacuum{-60, 1, 400, 400, -25, 1, 1};
  const auto part = invertible_part(model_named("zhang2025"), vacuum, sim::tick_s);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->left_out, std::vector<std::string>{"bouc_wen"});
}

TEST(InvertiblePart, AValveAloneHasNoInvertiblePart) {
  const model::Model valve = model::only(model_named("bench_twin"), [](const model::BlockInfo& info) {
    return info.station == model::Station::valve;
  });
  EXPECT_FALSE(invertible_part(valve, limits, sim::tick_s));
}

}  // namespace
}  // namespace softgrip::control::invertible_part_test
