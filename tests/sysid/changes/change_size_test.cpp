#include "sysid/changes/change_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::change_size_test {
namespace {

class FullPressure : public test::PressureBase {
 protected:
  /// Returns the mean, at full pressure, of an effect that is the magnitude of the drive.
  [[nodiscard]] double of_records(std::vector<Record> records) const {
    Binned none, added;
    for (const Record& record : records) {
      added.push_back(binned(record, record.drive_kpa, base_.bin_s));
      none.emplace_back(added.back().size(), 0.0);
      for (double& each : added.back()) each = std::abs(each);
    }
    return at_full_pressure(LaterReadings(base_, std::move(records), none), added);
  }
};

TEST_F(FullPressure, OfAVacuumActuatorIsItsStrongestVacuum) {
  std::vector<Record> vacuum = base_.records;
  double largest_kpa = 0;
  for (Record& record : vacuum) {
    largest_kpa = std::max(largest_kpa, record.largest_kpa);
    for (double& kpa : record.drive_kpa) kpa = -kpa;
  }
  const double by_pressure = of_records(base_.records);
  EXPECT_GT(by_pressure, 0.9 * largest_kpa);
  EXPECT_DOUBLE_EQ(of_records(vacuum), by_pressure);
}

class WholeGain : public test::PressureBase {
 protected:
  /// Returns the parameter of an effect on the pressure before the model, after the fit left another gain
  /// deviation of -4 %. The model is linear.
  [[nodiscard]] double number_of(const std::string& name) const {
    Effect effect;
    effect.numbers = {{name, "", 0.01, -0.9, 9}};
    effect.apply = [](Extension& e, const std::vector<double>& n) { e.load.factor *= 1 + n[0]; };
    return with_whole_gain(healthy_readings(base_), {effect, {-0.06}}, -0.04).numbers.front();
  }
};

TEST_F(WholeGain, IsInTheParameterOfAGainOrOfAModulus) {
  EXPECT_NEAR(number_of("gain_change"), -0.10, 0.001);
  EXPECT_NEAR(number_of("pressure_factor_change"), -0.10, 0.001);
  EXPECT_EQ(number_of("band_kpa"), -0.06);
}

class Shown : public test::PressureBase {
 protected:
  /// Returns an effect that increases the pressure by 10 % and has no rule for its size.
  [[nodiscard]] static FittedEffect tenth() {
    Effect effect;
    effect.id = "inertia";
    effect.numbers = {{"share", "s", 0.01, -0.9, 9, {}, "share of the pressure; a test"}};
    effect.nothing = {0};
    effect.apply = [](Extension& e, const std::vector<double>& n) { e.load.factor *= 1 + n[0]; };
    return {effect, {0.1}};
  }
  [[nodiscard]] ShownSize shown(const FittedEffect& effect, const Interval& size) const {
    return shown_size(readings_, effect, {effect.numbers, {Interval{0.05, 0.15}}, size});
  }

  const LaterReadings readings_ = healthy_readings(base_);
};

TEST_F(Shown, IsTheEffectAtFullPressureIfThisIsSignificant) {
  const ShownSize size = shown(tenth(), {1, 10});
  EXPECT_EQ(size.size.what, "effect at full pressure");
  EXPECT_GT(size.size.value, 3);
  EXPECT_EQ(size.interval->lower, 1);
}

TEST_F(Shown, IsTheParameterIfTheEffectAtFullPressureIsNotSignificant) {
  const ShownSize size = shown(tenth(), {-1, 10});
  EXPECT_EQ(size.size.what, "share of the pressure");
  EXPECT_EQ(size.size.value, 0.1);
  EXPECT_EQ(size.size.unit, "s");
  EXPECT_EQ(size.interval->lower, 0.05);
}

/// The command changes fast, so a delay has a large effect during ramps and nearly none at full pressure.
TEST_F(Shown, IsTheParameterIfTheEffectIsSmallerAtFullPressure) {
  FittedEffect late = tenth();
  late.effect.apply = [](Extension& e, const std::vector<double>& n) { e.line = {n[0], n[0]}; };
  EXPECT_EQ(shown(late, {-1.1, -0.9}).size.what, "share of the pressure");
}

TEST_F(Shown, IsNoParameterThatIsUndetermined) {
  FittedEffect effect = tenth();
  effect.effect.numbers.front().upper = 0.1;
  EXPECT_EQ(shown(effect, {-1, 10}).interval->upper, 10) << "at a bound";
  effect = tenth();
  effect.effect.nuisance_numbers = 1;
  EXPECT_EQ(shown(effect, {-1, 10}).interval->upper, 10) << "only a reference";
  effect = tenth();
  effect.effect.nothing = {0.06};
  EXPECT_EQ(shown(effect, {-1, 10}).interval->upper, 10) << "the interval contains the neutral value";
}

}  // namespace
}  // namespace softgrip::sysid::change_size_test
