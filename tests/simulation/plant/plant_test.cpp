#include "simulation/plant/plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/chain.h"
#include "model/file/model_file.h"

namespace softgrip::simulation::plant_test {
namespace {

model::Model twin() {
  document::Problems problems;
  const auto model = model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems);
  if (!model.has_value()) throw std::runtime_error(problems.format());
  return *model;
}

PlantSettings settings_of(const model::Model& model) {
  PlantSettings settings;
  settings.model = model;
  settings.sample_time_s = 0.005;
  return settings;
}

void settle(Plant& plant, double command_kpa, double seconds) {
  plant.command(command_kpa);
  for (int i = 0; i < static_cast<int>(seconds / 0.005); ++i) plant.advance(0.005);
}

// Without an object, the displacement of a plant must equal the displacement of its model bit for bit.
TEST(Plant, EqualsTheModelExactlyWithoutAnObject) {
  const unsigned seed = 5;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> command(0, 60);
  Plant plant(settings_of(twin()));
  model::Chain<double> chain(twin(), {}, 0.005);
  for (int i = 0; i < 2000; ++i) {
    const double u = i % 7 == 0 ? command(random) : plant.held_command_kpa();
    plant.command(u);
    plant.advance(0.005);
    if (chain.command_kpa() != u) chain.step(0, u);
    chain.step(0.005, u);
    ASSERT_EQ(plant.reading_mm(), chain.reading_mm()) << "sample " << i << ", seed " << seed;
    ASSERT_EQ(plant.pressure_kpa(), chain.pressure_kpa());
  }
  EXPECT_GT(plant.displacement_mm(), 1);
}

// Under a constant command, the displacement must not depend on the lengths of the simulation steps.
TEST(Plant, DisplacementIsIndependentOfTheStepSize) {
  Plant coarse(settings_of(twin()));
  Plant fine(settings_of(twin()));
  for (const double command : {30.0, 10.0, 50.0}) {
    coarse.command(command);
    fine.command(command);
    coarse.advance(0.5);
    for (int i = 0; i < 100; ++i) fine.advance(0.005);
    EXPECT_NEAR(coarse.displacement_mm(), fine.displacement_mm(), 1e-6);
  }
}

TEST(Plant, AnObjectLimitsTheMotionUntilRemoved) {
  PlantSettings settings = settings_of(twin());
  Plant free(settings);
  settings.object = PlantObject{.position_mm = 5, .yielding = 0.1};
  Plant held(settings);
  settle(free, 40, 5);
  settle(held, 40, 5);
  const double way = free.displacement_mm();
  ASSERT_GT(way, 6);
  EXPECT_NEAR(held.displacement_mm(), 5 + (way - 5) * 0.1, 1e-9);
  held.set_object(std::nullopt);  // removes the object from between the fingers
  held.advance(1e-6);
  EXPECT_NEAR(held.displacement_mm(), way, 1e-5);
  held.set_object(PlantObject{.position_mm = 2, .yielding = 0});
  held.advance(1e-6);
  EXPECT_NEAR(held.displacement_mm(), 2, 1e-4) << "a rigid object stops the finger at its position";
  free.advance(2e-6);
  held.set_object(std::nullopt);
  settle(free, 40, 1);
  settle(held, 40, 1);
  EXPECT_NEAR(held.displacement_mm(), free.displacement_mm(), 1e-9)
      << "an object that was removed has no effect";
}

TEST(Plant, AContactOfTheModelRemainsActive) {
  model::Model model = twin();
  model = model::with_block(model, {model::find_block("contact").value(), {4.0, 1.0}});
  Plant plant(settings_of(model));
  Plant free(settings_of(twin()));
  settle(plant, 40, 3);
  settle(free, 40, 3);
  const double stopped = 4 + (free.displacement_mm() - 4) / 2;
  EXPECT_NEAR(plant.displacement_mm(), stopped, 1e-9);
  plant.set_object(PlantObject{.position_mm = 3, .yielding = 0.5});
  plant.advance(1e-9);
  EXPECT_NEAR(plant.displacement_mm(), 3 + (stopped - 3) / 2, 1e-9);
}

TEST(Plant, ABlockedLineKeepsAndALeakReducesThePressure) {
  Plant plant(settings_of(twin()));
  settle(plant, 30, 2);
  plant.set_fault(LineFault{.kind = LineFault::Kind::blocked, .share = 0});
  settle(plant, 0, 2);
  EXPECT_NEAR(plant.pressure_kpa(), 30, 1e-6) << "a blocked air line keeps the pressure of the finger";
  EXPECT_EQ(plant.held_command_kpa(), 0);
  plant.set_fault(LineFault{});
  settle(plant, 0, 2);
  EXPECT_NEAR(plant.pressure_kpa(), 0, 1e-6);
  plant.set_fault(LineFault{.kind = LineFault::Kind::leaking, .share = 0.25});
  settle(plant, 40, 2);
  EXPECT_NEAR(plant.pressure_kpa(), 30, 1e-6);
}

TEST(Plant, SensorFaultsChangeOnlyTheReading) {
  Plant plant(settings_of(twin()));
  settle(plant, 30, 2);
  const double before = plant.reading_mm();
  plant.set_fault(SensorFault{.kind = SensorFault::Kind::stuck, .value_mm = 0});
  settle(plant, 60, 2);
  EXPECT_EQ(plant.reading_mm(), before);
  EXPECT_GT(plant.displacement_mm(), before + 1);
  plant.set_fault(SensorFault{.kind = SensorFault::Kind::offset, .value_mm = -4});
  EXPECT_NEAR(plant.reading_mm(), plant.displacement_mm() - 4, 1e-12);
  plant.set_fault(SensorFault{.kind = SensorFault::Kind::out_of_range, .value_mm = 0});
  EXPECT_TRUE(plant.sees_nothing());
  plant.set_fault(SensorFault{});
  EXPECT_FALSE(plant.sees_nothing());
  EXPECT_EQ(plant.reading_mm(), plant.displacement_mm());
}

TEST(Plant, NoiseHasTheGivenRmsAndDependsOnTheSeed) {
  PlantSettings settings = settings_of(twin());
  settings.displacement_noise_mm = 0.03;
  settings.pressure_noise_kpa = 0.2;
  settings.seed = 42;
  Plant first(settings);
  Plant second(settings);
  settings.seed = 43;
  Plant other(settings);
  double square = 0;
  double pressure_square = 0;
  int differing = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    for (Plant* plant : {&first, &second, &other}) plant->advance(0.005);
    ASSERT_EQ(first.reading_mm(), second.reading_mm());
    differing += first.reading_mm() != other.reading_mm() ? 1 : 0;
    square += first.reading_mm() * first.reading_mm();
    pressure_square += first.measured_pressure_kpa() * first.measured_pressure_kpa();
  }
  // The standard error of the RMS of 20,000 random numbers is 0.5 % of the RMS.
  EXPECT_NEAR(std::sqrt(square / count), 0.03, 0.03 * 0.02);
  EXPECT_NEAR(std::sqrt(pressure_square / count), 0.2, 0.2 * 0.02);
  EXPECT_EQ(differing, count);
}

TEST(Plant, IgnoresInvalidCommandsAndDurations) {
  Plant plant(settings_of(twin()));
  settle(plant, 20, 1);
  plant.command(std::nan(""));
  EXPECT_EQ(plant.held_command_kpa(), 20);
  plant.advance(-1);
  plant.advance(0);
  EXPECT_NEAR(plant.pressure_kpa(), 20, 1e-6);
}

}  // namespace
}  // namespace softgrip::simulation::plant_test
