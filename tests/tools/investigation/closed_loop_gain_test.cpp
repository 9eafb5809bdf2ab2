// Tests the computation of the improvement that the extended model gives in closed-loop control.

#include "tools/investigation/closed_loop_gain.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/relaxing_friction.h"
#include "model/file/model_file.h"
#include "model/named.h"

namespace softgrip::tools::closed_loop_gain_test {
namespace {

model::Model loaded(const std::string& name) {
  document::Problems problems;
  return model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/" + name + ".yaml", problems).value();
}

TEST(ClosedLoopGain, TheExtendedModelHalvesTheControlErrorOfTheRefittedModel) {
  ClosedLoopQuestion question;
  question.recalibrated = loaded("zhang2025");  // this model has no inverse
  question.extended = loaded("bench_twin");
  question.span_mm = 27;
  const ClosedLoopGain gain = measure_closed_loop(question);
#ifndef __SANITIZE_ADDRESS__  // with AddressSanitizer, the test takes ten times as long
  EXPECT_LT(gain.wall_s, 5);
#endif
  EXPECT_FALSE(gain.recalibrated.refused.empty());
  EXPECT_LT(gain.recalibrated.rmse_mm, gain.pid_alone.rmse_mm);
  EXPECT_TRUE(gain.extended.refused.empty()) << gain.extended.refused;
  EXPECT_LT(gain.extended.rmse_mm, 0.5 * gain.recalibrated.rmse_mm);
  EXPECT_EQ(gain.reference(), "13 ± 7 mm at 0.2 Hz");
  const auto json = result::json_of(fields_of(gain));
  EXPECT_EQ(json["extended_rmse_mm"], gain.extended.rmse_mm);
  EXPECT_EQ(json["gains"]["recalibrated"]["feedforward"], "planned");
  EXPECT_EQ(json["gains"]["extended"]["feedforward"], "full_model");
}

TEST(ClosedLoopGain, UsesPlannedFeedforwardForAModelWithoutAnInverse) {
  ClosedLoopQuestion question;
  question.recalibrated = loaded("bench_twin");
  question.extended = loaded("zhang2025");
  question.span_mm = 27;
  const ClosedLoopGain gain = measure_closed_loop(question);
  EXPECT_EQ(gain.extended.feedforward, control::FeedforwardKind::planned);
  EXPECT_LT(gain.extended.rmse_mm, 0.5 * gain.pid_alone.rmse_mm);
  EXPECT_FALSE(gain.extended.refused.empty());
  EXPECT_FALSE(gain.extended.trace.displacement_mm.empty());
  const auto json = result::json_of(fields_of(gain));
  EXPECT_EQ(json["gains"]["extended"]["feedforward"], "planned");
  EXPECT_NE(json["notes"].dump().find("is planned before the run"), std::string::npos);
}

/// The model contains friction that relaxes within a few ticks. This friction has no inverse. The time steps
/// of a planned feedforward are too long to compensate this friction. The other blocks predict most of the
/// motion, so the feedforward must use the model without the friction.
TEST(ClosedLoopGain, UsesTheInvertiblePartOfAModelAsFeedforward) {
  model::Model finger = model::with_block({}, {model::block_type<model::PrandtlIshlinskii>(),
                                               {0, 0, 0, 0, 0, 0.06, 4, 0.084, 7.3, 0.105, 11.2, 0.108}});
  finger = model::with_block(std::move(finger),
                             {model::block_type<model::KelvinVoigt>(), {1e9, 78, 55, 102, 71, 1.02, 8470}});
  finger = model::with_block(std::move(finger),
                             {model::block_type<model::RelaxingFriction>(), {0.79, 0.61, 0.05}});
  ClosedLoopQuestion question;
  question.recalibrated = question.extended = finger;
  question.span_mm = 15;
  const ClosedLoopGain gain = measure_closed_loop(question);
  EXPECT_EQ(gain.extended.feedforward, control::FeedforwardKind::full_model);
  EXPECT_LT(gain.extended.rmse_mm, 0.5 * gain.pid_alone.rmse_mm);
  ASSERT_TRUE(gain.extended.part);
  EXPECT_EQ(gain.extended.part->left_out, std::vector<std::string>{"relaxing_friction"});
  EXPECT_FALSE(model::position_of<model::RelaxingFriction>(gain.extended.part->model));
  EXPECT_FALSE(gain.extended.refused.empty());
  const auto json = result::json_of(fields_of(gain));
  EXPECT_EQ(json["gains"]["extended"]["feedforward_without"][0], "relaxing_friction");
  EXPECT_NE(json["notes"].dump().find("omits relaxing_friction"), std::string::npos);
}

TEST(ClosedLoopGain, UsesThePidAloneForAModelWithoutMotion) {
  ClosedLoopQuestion question;
  question.extended = loaded("bench_twin");
  question.recalibrated = model::only(
      question.extended, [](const model::BlockInfo& info) { return info.station == model::Station::valve; });
  question.span_mm = 27;
  const ClosedLoopGain gain = measure_closed_loop(question);
  EXPECT_EQ(gain.recalibrated.feedforward, control::FeedforwardKind::none);
  EXPECT_EQ(gain.recalibrated.rmse_mm, gain.pid_alone.rmse_mm);
  EXPECT_FALSE(gain.recalibrated.refused.empty());
  EXPECT_NE(gain.notes().front().find("PID controller alone"), std::string::npos);
}

TEST(ClosedLoopGain, IsReproducibleAndEqualForEqualModels) {
  ClosedLoopQuestion question;
  question.recalibrated = question.extended = loaded("bench_twin");
  question.span_mm = 11;  // half of the span of 22 mm that the reference 13 ± 7 mm needs
  const ClosedLoopGain one = measure_closed_loop(question);
  const ClosedLoopGain two = measure_closed_loop(question);
  EXPECT_EQ(one.extended.rmse_mm, two.extended.rmse_mm);
  EXPECT_EQ(one.extended.rmse_mm, one.recalibrated.rmse_mm);
  EXPECT_EQ(one.mean_mm, 6.5);
  EXPECT_EQ(one.amplitude_mm, 3.5);
}

}  // namespace
}  // namespace softgrip::tools::closed_loop_gain_test
