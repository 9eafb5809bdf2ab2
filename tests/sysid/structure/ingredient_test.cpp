#include "sysid/structure/structure.h"

#include <gtest/gtest.h>

#include <set>

namespace softgrip::sysid::ingredient_test {
namespace {

/// Returns a model structure that contains every available component.
BaseStructure complete() {
  return {.second_lag = true,
          .rate_limit = true,
          .regulator = true,
          .resonance = true,
          .envelopes = true,
          .hinged_creep = true,
          .modes = 2};
}

TEST(Ingredient, EachIsRemovableAndHasAUniqueName) {
  std::set<std::string_view> names;
  for (const Ingredient ingredient : all_ingredients) {
    SCOPED_TRACE(name_of(ingredient));
    names.insert(name_of(ingredient));
    EXPECT_TRUE(has(complete(), ingredient));
    const BaseStructure rest = without(complete(), ingredient);
    EXPECT_NE(rest, complete());
    EXPECT_FALSE(has(rest, ingredient));
    EXPECT_EQ(without(rest, ingredient), rest);
  }
  EXPECT_EQ(names.size(), all_ingredients.size());
}

TEST(Ingredient, RemovingALagRemovesTheLagExtensions) {
  const BaseStructure rest = without(complete(), Ingredient::lag);
  EXPECT_FALSE(rest.lag || rest.second_lag || rest.rate_limit);
  EXPECT_TRUE(rest.delay);
}

TEST(Ingredient, LatencyNeedsADelayAndALag) {
  for (const Ingredient one : {Ingredient::delay, Ingredient::lag})
    EXPECT_FALSE(has(without(complete(), one), Ingredient::latency));
}

}  // namespace
}  // namespace softgrip::sysid::ingredient_test
