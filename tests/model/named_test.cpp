#include "model/named.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/model/presets.h"

namespace softgrip::model::testing::named_test {
namespace {

static_assert(parameter_index<ValveLag>("time_constant_s") == 0);
static_assert(parameter_index<SlowCreep>("time_constant_s") == 1);
static_assert(parameter_index<KelvinVoigt>("c2_kpa_s_per_mm") == 4);

TEST(Named, TypesMatchTheCatalogue) {
  EXPECT_EQ(block_type<ValveLag>(), *find_block("valve_lag"));
  EXPECT_EQ(block_type<Quantisation>(), catalogue().size() - 1);
}

TEST(Named, EveryNameHasTheIndexOfItsValue) {
  const BlockSpec branches = default_block(block_type<KelvinVoigt>(), 8);
  EXPECT_EQ(find_parameter(branches, "k8_kpa_per_mm"), parameter_index<KelvinVoigt>("k8_kpa_per_mm"));
  const BlockSpec knots = default_block(block_type<SensorPiecewiseDrift>(), 16);
  EXPECT_EQ(find_parameter(knots, "knot16_mm"), parameter_index<SensorPiecewiseDrift>("knot16_mm"));
}

TEST(Named, UnspecifiedParametersAreNeutral) {
  const BlockSpec block = block_of<AsymmetricBoucWen>({{"epsilon_per_kpa", 0.3}});
  EXPECT_EQ(block, (BlockSpec{block_type<AsymmetricBoucWen>(), {0, 0.3, 0}}));
  EXPECT_EQ(block_of<ValveLag>({}), neutral_block(block_type<ValveLag>()));
}

TEST(Named, ValuesAreReadAndWrittenByName) {
  Model model = preset("bench_twin");
  ASSERT_NE(find_block<ValveLag>(model), nullptr);
  EXPECT_TRUE(is<ValveLag>(*find_block<ValveLag>(model)));
  value<ValveLag>(*find_block<ValveLag>(model), "time_constant_s") = 0.5;
  EXPECT_EQ(number(model, "valve_lag.time_constant_s"), 0.5);
  EXPECT_THROW((void)value<KelvinVoigt>(*find_block<KelvinVoigt>(model), "k8_kpa_per_mm"), std::out_of_range);
}

TEST(Named, FindsAndRemovesBlocksByType) {
  const Model model = preset("bench_twin");
  EXPECT_TRUE((has_any<Contact, ValveLag>(model)));
  EXPECT_FALSE((has_any<Contact, Inertia>(model)));
  EXPECT_EQ(find_block<Contact>(model), nullptr);
  EXPECT_EQ(position_of<BoucWen>(model), position_of(model, block_type<BoucWen>()));
  EXPECT_EQ((only<BoucWen, KelvinVoigt>(model).blocks.size()), 2u);
  EXPECT_FALSE(position_of<ValveLag>(without_block<ValveLag>(model)));
}

TEST(BlockDescriptor, AnInvalidParameterIndexThrows) {
  const BlockDescriptor& lag = catalogue()[block_type<ValveLag>()];
  EXPECT_THROW((void)lag.spec(1), std::out_of_range);
  const BlockDescriptor& spring = catalogue()[block_type<KelvinVoigt>()];
  EXPECT_EQ(spring.name(24), "c12_kpa_s_per_mm");
  EXPECT_THROW((void)spring.spec(25), std::out_of_range);
}

}  // namespace
}  // namespace softgrip::model::testing::named_test
