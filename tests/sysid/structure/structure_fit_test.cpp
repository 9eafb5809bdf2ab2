#include "sysid/structure/structure_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "model/blocks/linear_modes.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/transport_delay.h"
#include "model/chain.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure_choice.h"
#include "sysid/structure/structure_judge.h"
#include "tests/sysid/root_mean_square.h"

namespace softgrip::sysid::structure_fit_test {
namespace {

using test::rms;

constexpr double noise_mm = 0.02;

model::Model with_modes(std::vector<double> values) {
  const model::Model delayed = model::with_block({}, {model::block_type<model::TransportDelay>(), {0.07}});
  return model::with_block(delayed, {model::block_type<model::LinearModes>(), std::move(values)});
}

/// Returns a log of 24 s with pressures between 0 and 60 kPa. Each pressure is held for 0.2 to 1 s. The
/// readings are the prediction of the model plus noise.
/// @param skipped  number of samples at the beginning that the log does not contain. If it is not 0, each
/// pressure jumps at its sample.
Record random_steps(const model::Model& model, unsigned seed, std::ptrdiff_t skipped = 0) {
  RecordOptions options;
  options.held = skipped > 0;
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0, noise_mm);
  Log log;
  log.name = "random steps";
  double level_kpa = 0;
  std::size_t until = 25;
  for (std::size_t i = 0; i <= 1200; ++i) {
    if (i == until) {
      level_kpa = static_cast<double>(generator() % 61);
      until = i + 10 + generator() % 41;
    }
    log.time_s.push_back(0.02 * static_cast<double>(i));
    log.pressure_command_kpa.push_back(level_kpa);
  }
  log.displacement_mm.assign(log.size(), 0);
  log.displacement_mm = predict(model, make_records({log}, options)[0], {});
  for (double& y : log.displacement_mm) y += noise(generator);
  for (auto* column : {&log.time_s, &log.pressure_command_kpa, &log.displacement_mm})
    column->erase(column->begin(), column->begin() + skipped);
  return make_records({log}, options)[0];
}

StructureTrial chosen_for(const std::vector<Record>& records) {
  StructureChoiceOptions options;
  options.question = StructureQuestion::prandtl_ishlinskii;
  options.dynamics = true;
  const StructureChoice choice = choose_structure(records, options);
  return choice.trials[choice.chosen];
}

/// Returns the static gain of a model [mm/kPa].
double static_gain(const model::Model& model) {
  model::Chain<double> chain(model);
  chain.reset(50);
  const double high = chain.reading_mm();
  chain.reset(0);
  return (high - chain.reading_mm()) / 50;
}

/// Checks that the chosen structure has linear modes, that its error is the noise, and that it predicts
/// another log of the same model.
StructureTrial expect_found(const model::Model& truth) {
  const std::vector<Record> records{random_steps(truth, 1)};
  StructureTrial found = chosen_for(records);
  EXPECT_GE(found.structure.modes, 1U) << description_of(found.structure);
  EXPECT_LT(found.rmse_mm, 1.1 * noise_mm);
  const Record other = random_steps(truth, 2);
  EXPECT_LT(rms(residual(other, predict(found.point.model, other, {}))), 1.3 * noise_mm);
  return found;
}

TEST(LinearModes, ASecondModeIsFound) {
  const StructureTrial found = expect_found(with_modes({0, 1.2, 0.1, 0.2, 0, 0.31, 0.05, -0.05, 0.03}));
  EXPECT_GE(found.structure.modes, 2U);
  EXPECT_NEAR(static_gain(found.point.model), 0.15, 0.01);
}

TEST(LinearModes, AnInverseResponseIsFound) {
  // The gain for the rate and the static gain of this mode have opposite signs.
  expect_found(with_modes({0, 1.5, 1.4, 0.3, -0.4}));
}

TEST(LinearModes, ANegativeGainIsFound) {
  const StructureTrial found = expect_found(with_modes({0, 0.9, 0.7, -0.25, 0}));
  EXPECT_NEAR(static_gain(found.point.model), -0.25, 0.01);
}

TEST(LinearModes, AModeParallelToHysteresisIsFound) {
  const model::Model mode = with_modes({0, 0.9, 0.1, 0.1, 0});
  const std::vector<double> thresholds_kpa = grid_for({random_steps(mode, 1)}).thresholds_kpa;
  ASSERT_GT(thresholds_kpa.size(), 4U);
  const model::BlockSpec plays{model::block_type<model::PrandtlIshlinskii>(),
                               {0, 0, 0, 0, 0, 0.1, thresholds_kpa[1], 0.1, thresholds_kpa[4], 0.1}};
  const StructureTrial found = expect_found(model::with_block(mode, plays));
  EXPECT_TRUE(found.structure.hysteretic);
  EXPECT_FALSE(found.structure.linear);
}

// The log begins at the first step, so the mode is not at rest at the first pressure.
TEST(LinearModes, AStartDuringTheMotionIsEstimated) {
  const model::Model truth = with_modes({0, 1.5, 0.05, 0.25, 0});
  const std::vector<Record> records{random_steps(truth, 5, 25)};
  ASSERT_GT(records[0].drive_kpa.front(), 10);
  const StructureTrial found = chosen_for(records);
  EXPECT_TRUE(found.structure.linear) << description_of(found.structure);
  EXPECT_LT(found.rmse_mm, 1.1 * noise_mm);
  EXPECT_NEAR(rmse_of(found.point.model, found.point.starts, records), found.rmse_mm, 2e-4);
  FitSpace space(found.point.model, records, free_numbers(found.point.model));
  space.hold_arrivals(found.point.starts);
  const FitPoint again = space.point(space.z(found.point));
  EXPECT_NEAR(rmse_of(again.model, again.starts, records), found.rmse_mm, 1e-3);
}

TEST(LinearModes, ACompleteModelLeavesOnlyNoise) {
  const std::vector<Record> records{random_steps(with_modes({0.3, 1.2, 0.1, -0.1, 0.2}), 4)};
  const StructureChoiceOptions options;
  const StructureJudge judge(records, options);
  const StructureTrial still = judge.judge(BaseStructure{.characteristic = false}, 1e-5);
  EXPECT_FALSE(judge.is_noise(still));
  const BaseStructure extended{.hysteretic = false,
                               .lag = false,
                               .two_way = false,
                               .characteristic = false,
                               .modes = 1,
                               .linear = true};
  const StructureTrial complete = judge.judge_near(extended, 1e-5, still.numbers);
  EXPECT_LT(complete.rmse_mm, 1.1 * noise_mm);
  EXPECT_TRUE(judge.is_noise(complete));
  const StructureTrial worse = judge.judge_near(extended, 1e-5, still.numbers, 0.9 * complete.rmse_mm);
  EXPECT_TRUE(worse.block_losses_mm2.empty());
  EXPECT_DOUBLE_EQ(worse.rmse_mm, complete.rmse_mm);
}

TEST(LinearModes, ACandidateWithoutTheComponentIsNotFittedAgain) {
  const std::vector<Record> records{random_steps(with_modes({0.3, 1.2, 0.1, -0.1, 0.2}), 4)};
  StructureChoice choice;
  choice.trials.resize(2);
  choice.trials[0].structure = {.characteristic = false};
  choice.trials[0].heldout_rmse_mm = 123;
  choice.trials[1].structure = {.characteristic = true};
  choice.candidates = 2;
  choice.chosen = 1;
  constexpr std::array removed{Ingredient::characteristic};
  const std::vector<WithoutIngredient> ablation = ablation_of(records, choice, {}, removed);
  ASSERT_EQ(ablation.size(), 1U);
  EXPECT_EQ(ablation[0].trial.heldout_rmse_mm, 123);
}

TEST(LinearModes, ColumnsReproduceTheModelResponse) {
  const std::vector<Record> records{random_steps(with_modes({0, 0.9, 0.2, 0.25, 0}), 3)};
  const BaseStructure structure{.characteristic = false, .modes = 1};
  const FittedStructure fit = fit_form(records, structure, grid_for(records), {});
  const FitPoint point = point_of(fit, records, Drive::command);
  ASSERT_TRUE(model::find_block<model::LinearModes>(point.model) != nullptr);
  EXPECT_NEAR(rmse_of(point.model, point.starts, records), std::sqrt(fit.mean_square_mm2), 2e-5);
}

}  // namespace
}  // namespace softgrip::sysid::structure_fit_test
