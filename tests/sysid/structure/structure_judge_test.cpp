#include "sysid/structure/structure_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "model/blocks/ageing.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/named.h"
#include "sysid/fitting/start_estimate.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/division.h"

namespace softgrip::sysid::structure_judge_test {
namespace {

/// Returns a record of one pressure cycle from 0 to 60 kPa and back to 0. The readings are computed with
/// `model`.
Record stroke(const model::Model& model) {
  Log log;
  log.name = "stroke";
  for (int i = 0; i <= 240; ++i) {
    log.time_s.push_back(0.05 * i);
    log.pressure_command_kpa.push_back(i < 120 ? 0.5 * i : 0.5 * (240 - i));
  }
  log.displacement_mm.assign(log.size(), 0);
  Record record = make_records({log}, {})[0];
  record.reading_mm = predict(model, record, {});
  return record;
}

model::Model finger(double alpha_mm_per_kpa, double beta_mm_per_kpa) {
  return model::with_block(
      {}, {model::block_type<model::BoucWen>(), {alpha_mm_per_kpa, beta_mm_per_kpa, 0.004, 0.03, 1}});
}

TEST(StaysBounded, IsTrueForAnUnchangedFinger) {
  EXPECT_TRUE(stays_bounded({finger(0.5, 0.3), {StartState{}}}, {stroke(finger(0.5, 0.3))}));
}

TEST(StaysBounded, IsFalseForAResponseBeyondTheReadings) {
  const Record record = stroke(finger(0.5, 0.3));
  EXPECT_FALSE(stays_bounded({finger(2, 0.3), {StartState{}}}, {record}))
      << "the simulated response exceeds the readings in the first stroke";
  StartState away;
  away.offset_mm = -60;
  EXPECT_FALSE(stays_bounded({finger(0.5, 0.3), {away}}, {record}))
      << "the simulated response is below the readings";
}

TEST(StaysBounded, IsFalseIfTheSecondStrokeDiverges) {
  for (const bool runs_off : {false, true}) {
    const model::Model ageing = model::with_block(
        finger(0.5, 0.3), {model::block_type<model::Ageing>(), {runs_off ? 1000.0 : 100.0}});
    EXPECT_EQ(stays_bounded({ageing, {StartState{}}}, {stroke(ageing)}), !runs_off);
  }
}

TEST(StaysBounded, IsFalseIfOneRecordIsExceeded) {
  const model::Model model = finger(0.5, 0.3);
  Record small = stroke(model);
  for (double& reading : small.reading_mm) reading *= 0.1;
  EXPECT_FALSE(stays_bounded({model, {StartState{}, StartState{}}}, {stroke(model), small}));
}

/// Returns a log of 60 s that begins at 20 kPa while 4 mm of creep remain from the time before the log.
Log begun_during_creep() {
  Log log;
  log.name = "begun_during_creep";
  for (int i = 0; i < 1200; ++i) {
    const double t_s = 0.05 * i;
    log.time_s.push_back(t_s);
    log.pressure_command_kpa.push_back(30 - 10 * std::cos(1.1 * t_s) + 8 * std::sin(0.37 * t_s));
  }
  log.displacement_mm.assign(log.size(), 0);
  const model::Model creeping = model::with_block(
      finger(0.5, 0.1), {model::block_type<model::KelvinVoigt>(), {1e9, 10, 20}});  // time constant of 2 s
  StartState start;
  start.unsettled_mm = {-4};
  log.displacement_mm = predict(creeping, make_records({log}, {})[0], start);
  std::mt19937 random(7);
  std::normal_distribution<double> noise_mm(0, 0.02);
  for (double& reading : log.displacement_mm) reading += noise_mm(random);
  return log;
}

/// Returns the record of a log whose times and readings are multiplied by factors.
Record multiplied(Log log, double time_factor, double displacement_factor) {
  for (double& t_s : log.time_s) t_s *= time_factor;
  for (double& reading : log.displacement_mm) reading *= displacement_factor;
  return make_records({log}, {})[0];
}

TEST(StructureJudge, AnEstimatedStartDoesNotIncreaseTheErrorOnTheFirstBlock) {
  const std::vector<Record> records{multiplied(begun_during_creep(), 1, 1)};
  ASSERT_TRUE(records[0].start_unknown);
  const StructureChoiceOptions options;
  const StructureTrial trial = StructureJudge(records, options).judge({.characteristic = false}, 1e-5);
  ASSERT_EQ(trial.block_losses_mm2.size(), 10U);
  const double first_mm = std::sqrt(trial.block_losses_mm2[0]);
  EXPECT_LT(first_mm, 3 * trial.rmse_mm) << "RMSE of the fit: " << trial.rmse_mm;
}

TEST(StructureJudge, ABlockWithoutReadingsAfterTheStartIsNotJudged) {
  std::vector<Record> records{multiplied(begun_during_creep(), 1, 1)};
  // All readings of the first block except those that determine the start are missing.
  hide_readings(records[0], samples_for_start(records[0]) / 2, records[0].size() / 10);
  const StructureChoiceOptions options;
  const StructureTrial trial = StructureJudge(records, options).judge({.characteristic = false}, 1e-5);
  for (const double loss_mm2 : trial.block_losses_mm2) EXPECT_GT(loss_mm2, 0);
}

TEST(StructureJudge, TheErrorOfAnUnsettledStartDoesNotIncreaseInOtherUnits) {
  const BaseStructure structure{.characteristic = false};
  const StructureChoiceOptions options;
  const std::vector<Record> records{multiplied(begun_during_creep(), 1, 1)};
  const StructureTrial usual = StructureJudge(records, options).judge(structure, 1e-5);
  for (const auto& [time_factor, displacement_factor] :
       {std::pair{1.0, 0x1p-10}, std::pair{1000.0, 1.0}, std::pair{1000.0, 0x1p-8}}) {
    const std::vector<Record> other{multiplied(begun_during_creep(), time_factor, displacement_factor)};
    const StructureTrial trial = StructureJudge(other, options).judge(structure, 1e-5);
    EXPECT_TRUE(model::validate(trial.point.model).empty()) << time_factor << ' ' << displacement_factor;
    EXPECT_LT(trial.rmse_mm / displacement_factor, 1.01 * usual.rmse_mm)
        << time_factor << ' ' << displacement_factor;
    EXPECT_NEAR(rmse_of(trial.point.model, trial.point.starts, other) / trial.rmse_mm, 1, 1e-3)
        << time_factor << ' ' << displacement_factor;
  }
}

TEST(StructureJudge, TheErrorIsThatOfTheModelIfTheBlockCannotRepresentTheCreep) {
  const model::Model creeping =
      model::with_block(finger(0.5, 0.1), {model::block_type<model::KelvinVoigt>(), {1e9, 10, 20}});
  Log log;
  log.name = "slow_and_small";
  const Record usual = stroke(creeping);
  for (std::size_t i = 0; i < usual.size(); ++i) {
    log.time_s.push_back(usual.time_s[i]);
    log.pressure_command_kpa.push_back(usual.drive_kpa[i]);
    log.displacement_mm.push_back(usual.reading_mm[i]);
  }
  const std::vector<Record> records{multiplied(log, 1e5, 1e-6)};
  const StructureChoiceOptions options;
  const BaseStructure structure{.characteristic = false};
  const StructureJudge judge(records, options);
  ASSERT_TRUE(has_raised_creep(judge.fit(structure, 1e-5), records));
  const StructureTrial trial = judge.judge(structure, 1e-5);
  EXPECT_TRUE(model::validate(trial.point.model).empty());
  EXPECT_NEAR(rmse_of(trial.point.model, trial.point.starts, records) / trial.rmse_mm, 1, 1e-9);
}

}  // namespace
}  // namespace softgrip::sysid::structure_judge_test
