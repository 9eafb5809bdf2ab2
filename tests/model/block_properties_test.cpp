// Tests properties that every block of the catalogue must have. If a block is added to the catalogue, these
// tests cover it automatically.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "model/chain.h"
#include "model/chain_walk.h"
#include "model/dual.h"
#include "model/named.h"
#include "model/signals.h"
#include "tests/model/presets.h"

namespace softgrip::model::testing::block_properties_test {
namespace {

constexpr double tick_s = 5e-3;
constexpr SignalName signal = SignalName::tp2;

/// Calls `check` for every block type. If a check fails, the output contains the id of the block.
template <class Check>
void for_every_block(Check&& check) {
  for (std::size_t type = 0; type < catalogue().size(); ++type) {
    SCOPED_TRACE(catalogue()[type].info.id);
    check(type);
  }
}

/// Returns the model bench_twin. If bench_twin does not contain the block, adds it with the default values of
/// its parameters.
Model twin_with(std::size_t type) {
  const Model twin = preset("bench_twin");
  return position_of(twin, type) ? twin : with_block(twin, default_block(type));
}

/// Returns true if the block draws a random number for each sample.
bool is_random(std::size_t type) {
  return type == block_type<SensorNoise>() || type == block_type<Outliers>();
}

/// Returns surroundings (time, supply pressure and temperature) in which every block has an effect.
Surroundings around(double time_s) {
  return {time_s, 450 + 40 * std::sin(0.3 * time_s), 24 + 3 * std::cos(0.2 * time_s)};
}

template <class T>
T step_at(Chain<T>& chain, double time_s, double duration_s) {
  return chain.step(T(duration_s), T(value_kpa(signal, time_s)), around(time_s));
}

TEST(EveryBlock, DoesNothingAtItsNeutralValues) {
  const Model twin = preset("bench_twin");
  for_every_block([&](std::size_t type) {
    const Model extended = position_of(twin, type) ? twin : with_block(twin, neutral_block(type));
    ASSERT_TRUE(validate(extended).empty()) << validate(extended).front();
    ASSERT_TRUE(validate(twin_with(type)).empty()) << validate(twin_with(type)).front();
    Chain<double> with(extended), without(twin);
    for (int i = 1; i * tick_s < duration_s(signal); ++i)
      ASSERT_NEAR(step_at(with, i * tick_s, tick_s), step_at(without, i * tick_s, tick_s), 1e-9) << i;
  });
}

// The output segments of a block must follow each other without a gap in time or value. Their total duration
// must equal the duration of the input.
TEST(EveryBlock, PreservesDurationAndContinuity) {
  for (std::size_t type = 0; type < catalogue().size(); ++type) {
    const Model model{"one", "test", {default_block(type)}};
    const Chain<double> chain(model);
    AnyBlock<double> any = chain.block(0);
    std::visit(
        [&](auto& block) {
          if constexpr (requires(Segment<double> s) {
                          block.step(s, Surroundings{}, [](const Segment<double>&) {});
                        }) {
            std::mt19937 generator(91);
            std::uniform_real_distribution<double> value(-5, 60), length(1e-4, 0.2);
            block.reset(0.0);
            double last = block.output(), from = 0;
            for (int i = 0; i < 2000; ++i) {
              const double to = i % 5 == 0 ? from : value(generator);
              const double dt = i % 7 == 0 ? 0 : length(generator);
              Surroundings now;
              now.time_s = i;
              now.supply_kpa = 400 + value(generator);
              now.temperature_c = 20 + 0.1 * value(generator);
              double sum = 0;
              block.step(Segment<double>::straight(dt, from, to), now, [&](const Segment<double>& s) {
                ASSERT_NEAR(s.begin, last, 1e-9);
                ASSERT_GE(s.duration_s, 0);
                last = s.end;
                sum += s.duration_s;
              });
              from = to;
              ASSERT_NEAR(sum, dt, 1e-9) << catalogue()[type].info.id;
              ASSERT_NEAR(block.output(), last, 1e-9) << catalogue()[type].info.id;
            }
          }
        },
        any);
  }
}

// After reset(), the reading must stay constant while the command and the surroundings are constant.
TEST(EveryBlock, RestsAfterReset) {
  for_every_block([](std::size_t type) {
    if (is_random(type)) return;
    Surroundings still;
    still.time_s = 0;
    Chain<double> chain(twin_with(type), {}, tick_s);
    for (const double command_kpa : {0.0, 35.0, 10.0}) {
      chain.reset(command_kpa);
      const double rest_mm = chain.step(tick_s, command_kpa, still);
      for (int i = 0; i < 1000; ++i) ASSERT_NEAR(chain.step(tick_s, command_kpa, still), rest_mm, 1e-9) << i;
      chain.step(1.0, 60, still);
      chain.reset(command_kpa);
      ASSERT_NEAR(chain.step(tick_s, command_kpa, still), rest_mm, 1e-9)
          << "reset() must delete the stored history of the block";
    }
  });
}

// Simulates a linear command in one step and in two half steps. A block that is documented as exact must give
// the same reading in both cases. For every other block, the two readings may differ slightly for a step of 5
// ms.
TEST(EveryBlock, TwoHalfStepsEqualOneStep) {
  // These blocks are approximate in this chain. The first two blocks of the list are lags. A lag is exact for
  // a linear input, but here another lag precedes it.
  const std::vector<std::size_t> approximate{block_type<AsymmetricValveLag>(),
                                             block_type<ChamberLag>(),
                                             block_type<RateLimit>(),
                                             block_type<PressureRegulator>(),
                                             block_type<SupplySag>(),
                                             block_type<Leak>(),
                                             block_type<StressSoftening>(),
                                             block_type<PseudoElasticSoftening>(),
                                             block_type<CrescentHysteresis>(),
                                             block_type<PressureDependentCreep>(),
                                             block_type<LinearModes>(),
                                             block_type<RelaxingFriction>(),
                                             block_type<RateDependentWidth>(),
                                             block_type<RateDependentSaturation>(),
                                             block_type<Wear>(),
                                             block_type<Inertia>(),
                                             block_type<Backlash>(),
                                             block_type<SensorLag>()};
  for_every_block([&](std::size_t type) {
    // The clock offset uses the slope of the last step, so two half steps give another result than one step.
    // clock_offset_test.cpp tests this error.
    if (is_random(type) || type == block_type<ClockOffset>()) return;
    const double tolerance_mm = std::ranges::count(approximate, type) == 0 ? 1e-8 : 2e-4;
    Chain<double> whole(twin_with(type)), halves(twin_with(type));
    for (int i = 1; i * tick_s < duration_s(signal); ++i) {
      const double begin_kpa = value_kpa(signal, (i - 1) * tick_s), end_kpa = value_kpa(signal, i * tick_s);
      const double y = whole.step(tick_s, end_kpa, around(i * tick_s));
      halves.step(0.5 * tick_s, 0.5 * (begin_kpa + end_kpa), around((i - 0.5) * tick_s));
      ASSERT_NEAR(halves.step(0.5 * tick_s, end_kpa, around(i * tick_s)), y, tolerance_mm) << i;
    }
  });
}

// peek() must give the same result as step(), with one exception: only step() takes a corner of the pressure
// within a sample into account.
TEST(EveryBlock, PeekPredictsTheResultOfStep) {
  for_every_block([](std::size_t type) {
    const BlockInfo& info = catalogue()[type].info;
    if (info.inverse != Inverse::implicit) return;
    const double tolerance_mm = info.kind == Kind::pressure ? 1e-4 : 1e-12;
    const Model model =
        only(twin_with(type), [](const BlockInfo& i) { return i.inverse == Inverse::implicit; });
    Chain<double> chain(model, {}, tick_s);
    for (int i = 1; i * tick_s < duration_s(signal); ++i) {
      const double p = value_kpa(signal, i * tick_s);
      const double trial = chain.peek(tick_s, p, around(i * tick_s));
      ASSERT_NEAR(chain.peek(tick_s, Dual<double>(p, 1.0), around(i * tick_s)).a, trial, 1e-12) << i;
      ASSERT_NEAR(step_at(chain, i * tick_s, tick_s), trial, tolerance_mm) << i;
    }
  });
}

TEST(EveryBlock, DerivativesDoNotChangeTheResult) {
  for_every_block([](std::size_t type) {
    const Model model = twin_with(type);
    std::vector<Dual<double>> values;
    for (const double value : flat_values(model)) values.emplace_back(value, 1.0);
    Chain<double> plain(model, {}, tick_s, 7);
    Chain<Dual<double>> derived(model, values, tick_s, 7);
    for (int i = 1; i * tick_s < duration_s(signal); ++i) {
      const Dual<double> y = step_at(derived, i * tick_s, tick_s);
      ASSERT_NEAR(y.a, step_at(plain, i * tick_s, tick_s), 1e-10) << i;
      ASSERT_TRUE(std::isfinite(y.v)) << i;
    }
  });
}

}  // namespace
}  // namespace softgrip::model::testing::block_properties_test
