#include "sysid/import/role_fit.h"

#include <gtest/gtest.h>

#include <string>

namespace softgrip::sysid::role_fit_test {
namespace {

TableColumn column(const std::string& name) {
  TableColumn made;
  made.name = name;
  made.values = {0, 1, 2};
  return made;
}

TEST(RoleFit, AUnitAndANameFitBetterThanOneOfThem) {
  EXPECT_GT(fitness_for(column("pressure_kpa"), Role::pressure),
            fitness_for(column("pressure"), Role::pressure));
  EXPECT_GT(fitness_for(column("pressure"), Role::pressure),
            fitness_for(column("chamber_kpa"), Role::pressure));
  EXPECT_EQ(fitness_for(column("chamber"), Role::pressure), 0);
}

TEST(RoleFit, ACommandIsNoMeasuredPressure) {
  EXPECT_GT(fitness_for(column("p_set_kpa"), Role::command), 0);
  EXPECT_EQ(fitness_for(column("p_set_kpa"), Role::pressure), 0);
}

}  // namespace
}  // namespace softgrip::sysid::role_fit_test
