#include "model/chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/dual.h"
#include "model/signals.h"
#include "tests/model/presets.h"
#include "tests/support/allocation_counter.h"

namespace softgrip::model::testing::chain_test {
namespace {

/// Returns the model bench_twin, with all blocks of the catalogue added that bench_twin does not have.
Model everything(BlockSpec (*block_of)(std::size_t)) {
  Model model = preset("bench_twin");
  for (std::size_t type = 0; type < catalogue().size(); ++type) {
    if (!position_of(model, type)) model = with_block(model, block_of(type));
  }
  return model;
}
BlockSpec typical(std::size_t type) {
  return default_block(type);
}

std::vector<double> response(const Model& model, SignalName signal, double dt, double sample_time_s = 0,
                             std::uint64_t seed = 0) {
  Chain<double> chain(model, {}, sample_time_s, seed);
  const auto count = static_cast<int>(std::lround(duration_s(signal) / dt));
  std::vector<double> y;
  for (int i = 1; i <= count; ++i) {
    Surroundings around;
    around.time_s = i * dt;
    y.push_back(chain.step(dt, value_kpa(signal, i * dt), around));
  }
  return y;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::fmax(worst, std::fabs(a[i] - b[i]));
  return worst;
}

TEST(Chain, NeutralBlocksHaveNoEffect) {
  for (const std::string_view id : {"bouc_wen", "kelvin_voigt"}) {
    const std::size_t type = *find_block(id);
    Model lonely;
    lonely.blocks.push_back(neutral_block(type));
    for (const double y : response(lonely, SignalName::tp1, 5e-3)) ASSERT_NEAR(y, 0, 1e-6) << id;
  }
  for (const std::string_view id : {"transport_delay", "valve_lag"}) {
    Model twin = preset("bench_twin");
    const Model without = without_block(twin, *find_block(id));
    twin.blocks[*position_of(twin, id)] = neutral_block(*find_block(id));
    EXPECT_EQ(response(twin, SignalName::tp2, 5e-3), response(without, SignalName::tp2, 5e-3)) << id;
  }
}

TEST(Chain, StepSizeDoesNotMatterOnAStraightCommand) {
  const Model twin = preset("bench_twin");
  const std::vector<double> coarse = response(twin, SignalName::steps, 0.05);
  const std::vector<double> fine = response(twin, SignalName::steps, 0.001);
  for (std::size_t i = 0; i < coarse.size(); ++i) ASSERT_NEAR(coarse[i], fine[(i + 1) * 50 - 1], 1e-6) << i;
}

TEST(Chain, NominalSampleTimeChangesNothing) {
  const Model twin = preset("bench_twin");
  EXPECT_LT(
      largest_difference(response(twin, SignalName::tp1, 5e-3, 5e-3), response(twin, SignalName::tp1, 5e-3)),
      1e-12);
}

TEST(Chain, RoundedTimestampsCountAsTheNominalSampleTime) {
  const Model twin = preset("bench_twin");
  Chain<double> exact(twin, {}, 5e-3), rounded(twin, {}, 5e-3);
  for (int i = 1; i < 2000; ++i) {
    const double u = value_kpa(SignalName::tp1, i * 5e-3);
    ASSERT_EQ(exact.step(5e-3, u), rounded.step(1000 + i * 5e-3 - (1000 + (i - 1) * 5e-3), u));
  }
}

TEST(Chain, ReturnsTheSignalOfEachComponent) {
  Model model = preset("bench_twin");
  model = with_block(model, {*find_block("contact"), {5.0, 2.0}});
  model = with_block(model, {*find_block("quantisation"), {0.5}});
  Chain<double> chain(model);
  for (int i = 1; i <= 1000; ++i) chain.step(5e-3, value_kpa(SignalName::tp1, i * 5e-3));
  EXPECT_EQ(chain.command_kpa(), 60);
  EXPECT_NEAR(chain.pressure_kpa(), 60 - 12 * 0.174,
              0.1);  // the command rises by 12 kPa/s; dead time and lag delay the pressure by 0.174 s
  const double free = chain.after(Station::actuator);
  EXPECT_GT(free, 5);
  EXPECT_NEAR(chain.after(Station::load), 5 + (free - 5) / 3, 1e-12);
  EXPECT_NEAR(chain.reading_mm(), chain.after(Station::load), 0.25);
  EXPECT_EQ(std::fmod(chain.reading_mm(), 0.5), 0);

  Chain<double> bare(preset("zhang2025"));
  bare.step(0.1, 20);
  EXPECT_EQ(bare.pressure_kpa(), 20);
  EXPECT_EQ(bare.after(Station::actuator), bare.reading_mm());
  EXPECT_EQ(bare.after(Station::load), bare.reading_mm());
}

TEST(Chain, ResetReachesTheStateAfterARiseAndALongHold) {
  const Model model = with_block(preset("bench_twin"), {*find_block("contact"), {5.0, 2.0}});
  Chain<double> risen(model);
  risen.step(10, 35);
  for (int i = 0; i < 10000; ++i) risen.step(0.05, 35);
  Chain<double> rested(model);
  rested.reset(35);
  EXPECT_NEAR(rested.reading_mm(), risen.reading_mm(), 1e-9);
  EXPECT_NEAR(rested.step(0.1, 30), risen.step(0.1, 30), 1e-9);
  rested.reset(0);
  EXPECT_EQ(rested.reading_mm(), 0);
  EXPECT_EQ(rested.pressure_kpa(), 0);
}

TEST(Chain, AStepOfTheCommandEqualsAVerySteepRamp) {
  // Compares the response to a jump of the command with the response to a very steep ramp.
  const Model twin = preset("bench_twin");
  Chain<double> held(twin, {}, 5e-3), steep(twin);
  for (int i = 0; i < 3000; ++i) {
    const double u = value_kpa(SignalName::tp1, i * 5e-3);
    held.step(0, u);
    steep.step(1e-9, u);
    ASSERT_NEAR(held.step(5e-3, u), steep.step(5e-3 - 1e-9, u), 1e-6);
  }
}

TEST(Chain, CopiesAreIndependent) {
  Chain<double> a(everything(typical), {}, 1e-3, 5);
  for (int i = 1; i < 500; ++i) a.step(1e-3, 0.1 * i);
  Chain<double> b = a;
  const double y = a.step(1e-3, 40);
  a.step(1e-3, 0);
  EXPECT_EQ(b.step(1e-3, 40), y);
}

TEST(Chain, OnlyEqualSeedsGiveEqualReadings) {
  const Model model = with_block(preset("bench_twin"), {*find_block("sensor_noise"), {0.05, 0.02}});
  EXPECT_EQ(response(model, SignalName::tp1, 5e-3, 5e-3, 9), response(model, SignalName::tp1, 5e-3, 5e-3, 9));
  EXPECT_NE(response(model, SignalName::tp1, 5e-3, 5e-3, 9), response(model, SignalName::tp1, 5e-3, 5e-3, 8));
}

TEST(Chain, SteppingAllocatesNothing) {
  for (const double rate_hz : {200.0, 1000.0}) {
    const double dt = 1 / rate_hz;
    Chain<double> chain(everything(typical), {}, dt, 3);
    const Chain<double> start = chain;
    double sum = 0;
    const std::size_t made = softgrip::test::allocations_of([&] {
      for (int i = 1; i < 5000; ++i) {
        const double u = value_kpa(SignalName::tp1, i * dt);
        chain.step(0, u);
        sum += chain.peek(dt, u) + chain.peek(dt, Dual<double>(u, 1.0)).v;
        sum += chain.step(dt, u);
      }
      chain.reset(0);
      chain = start;
    });
    EXPECT_EQ(made, 0U);
    EXPECT_TRUE(std::isfinite(sum));
  }
}

TEST(Chain, GivenValuesReplaceTheValuesOfTheModel) {
  const Model twin = preset("bench_twin");
  std::vector<double> values = flat_values(twin);
  for (double& v : values) v *= v == 1.0 ? 1.0 : 1.1;
  Chain<double> a(twin, values), b(with_values(twin, values));
  for (int i = 1; i < 500; ++i) ASSERT_EQ(a.step(0.01, 0.1 * i), b.step(0.01, 0.1 * i));
}

TEST(Chain, FindsTheBlocksOfTheModelByType) {
  const Chain<double> chain(preset("bench_twin"));
  ASSERT_NE(chain.find<TransportDelay<double>>(), nullptr);
  EXPECT_EQ(chain.find<TransportDelay<double>>()->delay_s(), 0.13);
  EXPECT_EQ(chain.find<Contact<double>>(), nullptr);
  EXPECT_EQ(chain.size(), 4u);
}

// For all valid parameter values, the readings must be finite.
TEST(Chain, AnyAllowedNumbersGiveFiniteReadings) {
  std::mt19937 generator(2024);
  for (int round = 0; round < 300; ++round) {
    Model model = everything(typical);
    for (BlockSpec& block : model.blocks) {
      const BlockDescriptor& descriptor = catalogue()[block.type];
      const std::vector<double> typical_values = block.values;
      for (std::size_t i = 0; i < block.values.size(); ++i) {
        const ParameterSpec& spec = descriptor.spec(i);
        const double pick = std::uniform_real_distribution<double>(0, 1)(generator);
        if (pick < 0.15) block.values[i] = spec.lower;
        if (pick > 0.85) block.values[i] = spec.upper;
      }
      if (descriptor.objection != nullptr && !descriptor.objection(block.values).empty()) {
        block.values = typical_values;
      }
    }
    ASSERT_TRUE(validate(model).empty()) << validate(model).front();
    Chain<double> chain(model, {}, 5e-3, 1);
    for (int i = 1; i < 400; ++i) {
      Surroundings around{i * 5e-3, 50, 25};
      const double y = chain.step(i % 3 == 0 ? 0 : 5e-3, 60 * std::fabs(std::sin(0.05 * i)), around);
      ASSERT_TRUE(std::isfinite(y)) << "round " << round << " sample " << i;
    }
  }
}

}  // namespace
}  // namespace softgrip::model::testing::chain_test
