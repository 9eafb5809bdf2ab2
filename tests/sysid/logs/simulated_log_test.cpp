#include "sysid/logs/simulated_log.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/blocks/thermal_gain.h"
#include "model/file/model_file.h"
#include "model/named.h"

namespace softgrip::sysid::simulated_log_test {
namespace {

model::Model twin() {
  document::Problems problems;
  auto model = model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems);
  EXPECT_TRUE(model) << problems.format();
  return *model;
}

TEST(SampledSignal, EndsWhereTheSignalEnds) {
  for (const auto& [signal, name] : model::signal_names) {
    SCOPED_TRACE(name);
    for (const double rate_hz : {7.0, 100.0, 1000.0}) {
      const Log log = sampled_signal(signal, rate_hz);
      ASSERT_FALSE(log.time_s.empty());
      EXPECT_EQ(log.time_s.front(), 0);
      EXPECT_LE(log.time_s.back(), model::duration_s(signal) + 1e-9);
      EXPECT_GT(log.time_s.back(), model::duration_s(signal) - 1 / rate_hz);
      EXPECT_EQ(log.pressure_command_kpa[log.size() / 2],
                model::value_kpa(signal, log.time_s[log.size() / 2]));
    }
  }
}

TEST(Simulate, DoesNotDependOnTheRate) {
  const model::Model model = twin();
  Log coarse = sampled_signal(model::SignalName::sp1, 50);
  Log fine = sampled_signal(model::SignalName::sp1, 500);
  simulate(model, {}, coarse);
  simulate(model, {}, fine);
  // The command is smooth. Linear interpolation over 20 ms therefore changes the response by much less than
  // this tolerance.
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    ASSERT_NEAR(coarse.displacement_mm[i], fine.displacement_mm[10 * i], 0.01)
        << "at " << coarse.time_s[i] << " s";
  }
}

TEST(Simulate, ResultIsReproducibleAndDependsOnTheSeed) {
  const model::Model model = twin();
  const auto with_seed = [&](std::uint64_t seed) {
    Log log = sampled_signal(model::SignalName::tp1, 20);
    simulate(model, {0.05, seed}, log);
    return log.displacement_mm;
  };
  EXPECT_EQ(with_seed(7), with_seed(7));
  EXPECT_NE(with_seed(7), with_seed(8));
}

TEST(Simulate, AddsWhiteNoiseOfTheGivenSize) {
  const model::Model model = twin();
  Log clean = sampled_signal(model::SignalName::tp1, 200);
  Log noisy = clean;
  simulate(model, {}, clean);
  constexpr double noise_mm = 0.05;
  simulate(model, {noise_mm, 11}, noisy);
  double sum = 0;
  double squares = 0;
  double neighbours = 0;
  double before = 0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const double noise = noisy.displacement_mm[i] - clean.displacement_mm[i];
    sum += noise;
    squares += noise * noise;
    neighbours += noise * before;
    before = noise;
  }
  const auto count = static_cast<double>(clean.size());
  const double four_sigma = 4 / std::sqrt(count);
  EXPECT_NEAR(sum / count / noise_mm, 0, four_sigma);
  EXPECT_NEAR(squares / count / (noise_mm * noise_mm), 1, four_sigma * std::sqrt(2.0));
  EXPECT_NEAR(neighbours / squares, 0, four_sigma) << "lag-1 correlation";
}

TEST(Simulate, UsesTheTimesOfAnIrregularLog) {
  const model::Model model = twin();
  Log regular = sampled_signal(model::SignalName::tp2, 1000);
  simulate(model, {}, regular);
  // Keep samples at unequal distances. The command must remain linear between the kept samples.
  Log irregular;
  for (std::size_t i = 0; i < regular.size(); i += 1 + i % 3) {
    irregular.time_s.push_back(regular.time_s[i]);
    irregular.pressure_command_kpa.push_back(regular.pressure_command_kpa[i]);
  }
  simulate(model, {}, irregular);
  std::size_t k = 0;
  for (std::size_t i = 0; i < regular.size(); i += 1 + i % 3, ++k) {
    ASSERT_NEAR(irregular.displacement_mm[k], regular.displacement_mm[i], 1e-3)
        << "at " << regular.time_s[i] << " s";
  }
}

TEST(Simulate, FillsGapsOfSupplyAndTemperature) {
  model::Model model = twin();
  model = model::with_block(model, model::block_of<model::ThermalGain>({{"gain_per_c", 0.02}}));
  Log whole = sampled_signal(model::SignalName::tp1, 20);
  whole.temperature_c.assign(whole.size(), 35);
  Log gaps = whole, none = whole, absent = whole;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (i % 10 != 3) gaps.temperature_c[i] = std::nan("");
    none.temperature_c[i] = std::nan("");
  }
  absent.temperature_c.clear();
  for (Log* log : {&whole, &gaps, &none, &absent}) simulate(model, {}, *log);
  EXPECT_EQ(gaps.displacement_mm, whole.displacement_mm);
  EXPECT_EQ(none.displacement_mm, absent.displacement_mm);
  EXPECT_NE(none.displacement_mm, whole.displacement_mm);
}

TEST(Simulate, StartsAtRestAtTheFirstCommand) {
  const model::Model model = twin();
  Log log;
  for (int i = 0; i < 100; ++i) {
    log.time_s.push_back(0.1 * i);
    log.pressure_command_kpa.push_back(40);
  }
  simulate(model, {}, log);
  EXPECT_GT(log.displacement_mm.front(), 5);
  EXPECT_NEAR(log.displacement_mm.front(), log.displacement_mm.back(), 1e-9);
}

}  // namespace
}  // namespace softgrip::sysid::simulated_log_test
