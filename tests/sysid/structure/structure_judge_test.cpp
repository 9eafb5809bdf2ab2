#include "sysid/structure/structure_judge.h"

#include <gtest/gtest.h>

#include "model/blocks/ageing.h"
#include "model/blocks/bouc_wen.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"

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

}  // namespace
}  // namespace softgrip::sysid::structure_judge_test
