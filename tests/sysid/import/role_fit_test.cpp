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

TEST(RoleFit, ADerivedValueIsNoReading) {
  for (const char* name : {"p_error_kpa", "pErr [kPa]", "Pressure deviation (kPa)", "p_dev_kpa", "p_diff_kpa",
                           "p_rate_kpa", "p_dot", "p_std_kpa", "pressure noise [kPa]", "sp_minus_p_kpa"}) {
    EXPECT_TRUE(names_derived_value(name)) << name;
    EXPECT_EQ(fitness_for(column(name), Role::pressure), 0) << name;
    EXPECT_EQ(fitness_for(column(name), Role::command), 0) << name;
  }
  EXPECT_EQ(fitness_for(column("x_err_mm"), Role::displacement), 0);
  EXPECT_EQ(fitness_for(column("left_age_s"), Role::time), 0);
  EXPECT_EQ(fitness_for(column("tip_velocity_mm"), Role::displacement), 0);
}

TEST(RoleFit, APartOfAWordStatesNoDerivedValue) {
  for (const char* name : {"p_standard_kpa", "pirate_kpa", "dev1_p_kpa", "operator_p_kpa", "p_dots_kpa"}) {
    EXPECT_FALSE(names_derived_value(name)) << name;
    EXPECT_GT(fitness_for(column(name), Role::pressure), 0) << name;
  }
}

}  // namespace
}  // namespace softgrip::sysid::role_fit_test
