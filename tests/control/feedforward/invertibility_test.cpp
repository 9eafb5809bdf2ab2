#include "control/feedforward/invertibility.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "model/blocks/asymmetric_bouc_wen.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/linear_modes.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/rate_limit.h"
#include "model/blocks/valve_deadband.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "tests/control/simulated_finger.h"

namespace softgrip::control::invertibility_test {
namespace {

using sim::model_named;

constexpr LimitSettings limits{0, 60, 400, 400, 0, 25, 1};

tl::expected<void, Refusal> check(const model::Model& model, FeedforwardKind kind) {
  return check_feedforward(model, {kind, 0}, limits, sim::tick_s);
}

model::Model with_value(const model::Model& model, const std::string& path, double value) {
  auto values = model::flat_values(model);
  values[model::find_path(model, path).value()] = value;
  return model::with_values(model, values);
}

TEST(Invertibility, ThePublishedModelIsRefusedForFullModelAndBoucWen) {
  const model::Model published = model_named("zhang2025");
  const auto full = check(published, FeedforwardKind::full_model);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().with_advice(),
            "beta > alpha + 1/k0 (0.1721 > 0.07386 mm/kPa): the model has an inverse response; the usual "
            "cause is a latency in the data that the model lacks: run `softgrip diagnose`");
  const auto part = check(published, FeedforwardKind::bouc_wen);
  ASSERT_FALSE(part);
  EXPECT_EQ(part.error().with_advice(),
            "beta > alpha (0.1721 > 0.07079 mm/kPa): the model has an inverse response; the usual cause is a "
            "latency in the data that the model lacks: run `softgrip diagnose`");
  EXPECT_TRUE(check(published, FeedforwardKind::none));
}

TEST(Invertibility, BenchTwinIsAcceptedForFullModelAndBoucWen) {
  const model::Model twin = model_named("bench_twin");
  EXPECT_TRUE(check(twin, FeedforwardKind::full_model));
  EXPECT_TRUE(check(twin, FeedforwardKind::bouc_wen));
}

TEST(Invertibility, PlayOperatorsAreAcceptedForFullModelNotForBoucWen) {
  const model::Model arm = model_named("soft_arm_play");
  EXPECT_TRUE(check(arm, FeedforwardKind::full_model));
  const auto part = check(arm, FeedforwardKind::bouc_wen);
  ASSERT_FALSE(part);
  EXPECT_EQ(
      part.error().with_advice(),
      "the feedforward `bouc_wen` is the inverse of a `bouc_wen` block, but the model has no such block; the "
      "feedforward `full_model` is the inverse of the complete model");
}

// A play operator does not move while its input stays within its threshold. Within the threshold, the finger
// moves by creep only.
TEST(Invertibility, PlaysWithoutAnElasticPartAreRefused) {
  const model::Model creep =
      model::with_block({}, {model::block_type<model::KelvinVoigt>(), {1e9, 40, 20, 40, 200}});
  const auto with_plays = [&](double threshold_kpa) {
    return model::with_block(
        creep, {model::block_type<model::PrandtlIshlinskii>(), {0, 0, 0, 0, threshold_kpa, 0.1, 10, 0.1}});
  };
  for (const model::Model& dead : {creep, with_plays(5)}) {
    const auto refused = check(dead, FeedforwardKind::full_model);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("the model moves only by creep"), std::string::npos)
        << refused.error().text;
    EXPECT_TRUE(check(dead, FeedforwardKind::planned));
  }
  EXPECT_TRUE(check(with_plays(0), FeedforwardKind::full_model));
}

// The gain of this model is positive at 0 kPa, but hysteresis makes the gain negative at higher pressures. To
// find the negative gain, the check must evaluate the whole pressure range.
TEST(Invertibility, ANegativeGainInsideThePressureRangeIsRefused) {
  const model::Model twin = model_named("bench_twin");
  const model::Model hidden = with_value(twin, "bouc_wen.alpha_mm_per_kpa", 0.1800);
  const auto refused = check(hidden, FeedforwardKind::full_model);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("the instantaneous gain is -"), std::string::npos)
      << refused.error().text;
  EXPECT_NE(refused.error().text.find("kPa while the pressure"), std::string::npos) << refused.error().text;
  // From 0 to 5 kPa, the gain of this model is positive everywhere.
  LimitSettings small = limits;
  small.pressure_max_kpa = 5;
  EXPECT_TRUE(check_feedforward(hidden, {FeedforwardKind::full_model, 0}, small, sim::tick_s));
}

// If a hysteresis loop has different slopes at its two ends, the inverse can be missing at one end and exist
// at the other.
TEST(Invertibility, ARefusalNamesTheDirectionOfTheNegativeGain) {
  const auto skewed = [](double epsilon_per_kpa) {
    model::Model even = with_value(model_named("bench_twin"), "bouc_wen.eta_per_kpa", 0.02);
    even = with_value(even, "bouc_wen.gamma_per_kpa", 0.02);
    return model::with_block(
        even, model::block_of<model::AsymmetricBoucWen>({{"epsilon_per_kpa", epsilon_per_kpa}}));
  };
  EXPECT_TRUE(check(skewed(0), FeedforwardKind::full_model));
  for (const auto& [epsilon_per_kpa, way] : {std::pair(0.02, "rises"), std::pair(-0.02, "falls")}) {
    const auto refused = check(skewed(epsilon_per_kpa), FeedforwardKind::full_model);
    ASSERT_FALSE(refused) << way;
    EXPECT_NE(refused.error().text.find(std::string("while the pressure ") + way), std::string::npos)
        << refused.error().text;
  }
}

TEST(Invertibility, BetaEqualToAlphaIsRefused) {
  const model::Model twin = model_named("bench_twin");
  const auto refused =
      check(with_value(twin, "bouc_wen.beta_mm_per_kpa", 0.21105), FeedforwardKind::bouc_wen);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("beta = alpha"), std::string::npos) << refused.error().text;
}

TEST(Invertibility, ARefusalNamesTheMissingBlock) {
  const model::Model linear = model::without_block(model_named("bench_twin"), *model::find_block("bouc_wen"));
  EXPECT_TRUE(check(linear, FeedforwardKind::full_model));
  const auto refused = check(linear, FeedforwardKind::bouc_wen);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("`bouc_wen`"), std::string::npos);
  model::Model valve_only = model_named("bench_twin");
  valve_only = model::only(
      valve_only, [](const model::BlockInfo& info) { return info.station == model::Station::valve; });
  EXPECT_FALSE(check(valve_only, FeedforwardKind::full_model));
}

// Adds each block of the catalogue that the model lacks. The feedforward may accept the model only if it can
// invert or ignore the block. A refusal must name the block, unless the block has an implicit inverse.
TEST(Invertibility, EveryBlockIsInvertedOrNamedInTheRefusal) {
  const model::Model twin = model_named("bench_twin");
  for (std::size_t type = 0; type < model::catalogue().size(); ++type) {
    const model::BlockInfo& info = model::catalogue()[type].info;
    if (model::position_of(twin, type)) continue;
    const auto answer =
        check(model::with_block(twin, model::default_block(type)), FeedforwardKind::full_model);
    if (answer) {
      const bool harmless = info.station == model::Station::sensor ||
                            info.inverse == model::Inverse::ignored ||
                            info.inverse == model::Inverse::implicit ||
                            model::is<model::PressureSaturation, model::AsymmetricValveLag, model::ChamberLag,
                                      model::RateLimit, model::PressureRegulator, model::ValveDeadband>(info);
      EXPECT_TRUE(harmless) << info.id;
    } else if (info.inverse != model::Inverse::implicit) {
      EXPECT_NE(answer.error().text.find(info.id), std::string::npos) << answer.error().text;
    }
  }
}

// Tests blocks whose type is not in the catalogue.
TEST(Invertibility, NotUndoneNamesEveryBlockWithoutAnInverse) {
  using enum model::Inverse;
  const auto block = [](std::string_view id, model::Station station, model::Inverse inverse) {
    return model::BlockInfo{id, station, model::Kind::pressure, inverse, "", "", "", false};
  };
  const auto named = [&](model::Station station, model::Inverse inverse) {
    const std::array blocks{block("new", station, inverse)};
    return not_undone(blocks) == "`new`";
  };
  for (const model::Inverse inverse : {implicit, lead, preview, play, bound, none, ignored}) {
    EXPECT_FALSE(named(model::Station::sensor, inverse))
        << "a sensor block does not move the finger, so it needs no inverse";
    for (const model::Station station : {model::Station::actuator, model::Station::load}) {
      EXPECT_EQ(named(station, inverse), inverse != implicit && inverse != ignored);
    }
    // The feedforward inverts a lag, a dead band or a bound of the valve only if the type of the block is in
    // its list. The type `new` is not in this list.
    EXPECT_EQ(named(model::Station::valve, inverse),
              inverse == lead || inverse == play || inverse == bound || inverse == none);
  }
  const std::array three{block("first", model::Station::valve, lead),
                         block("fine", model::Station::load, implicit),
                         block("second", model::Station::actuator, bound)};
  EXPECT_EQ(not_undone(three), "`first`, `second`");
  for (const model::BlockDescriptor& known : model::catalogue()) {
    const std::string_view id = known.info.id;
    EXPECT_EQ(not_undone({&known.info, 1}), id == "linear_modes" ? "`linear_modes`" : "") << id;
  }
}

TEST(Invertibility, WithoutCreepOnlyTheHysteresisIsChecked) {
  const model::Model elastic = model::without_block<model::KelvinVoigt>(model_named("bench_twin"));
  EXPECT_TRUE(check(elastic, FeedforwardKind::full_model));
  const auto refused =
      check(with_value(elastic, "bouc_wen.alpha_mm_per_kpa", 0.1), FeedforwardKind::full_model);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text.find("beta > alpha (0.1713 > 0.1 mm/kPa)"), 0U) << refused.error().text;
}

TEST(Invertibility, PlanningRequiresAMovingFingerWithPositiveGain) {
  const model::Model twin = model_named("bench_twin");
  EXPECT_TRUE(check(twin, FeedforwardKind::planned));
  const model::Model valve_only =
      model::only(twin, [](const model::BlockInfo& info) { return info.station == model::Station::valve; });
  const auto nothing = check(valve_only, FeedforwardKind::planned);
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().text.find("no element that moves the finger"), std::string::npos);
  model::Model backwards =
      model::only(twin, [](const model::BlockInfo& info) { return info.id == "bouc_wen"; });
  backwards = with_value(backwards, "bouc_wen.alpha_mm_per_kpa", -0.1);
  const auto refused = check(backwards, FeedforwardKind::planned);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("requires a gain above 0"), std::string::npos) << refused.error().text;
}

// A finger whose displacement decays under a constant command has a settled gain of about 0, with the sign of
// a rounding error.
TEST(Invertibility, ADecayingDeflectionIsRefusedWithoutSignAdvice) {
  const auto modes = [](double direct_mm_per_kpa) {
    return model::with_block(
        {}, {model::block_type<model::LinearModes>(), {direct_mm_per_kpa, 0.5, 0.4, -0.3, 0.1}});
  };
  for (const double direct : {0.3, 0.3 + 5e-6, 0.3 - 5e-6, 0.31, 0.29}) {
    const auto refused = check(modes(direct), FeedforwardKind::planned);
    ASSERT_FALSE(refused) << direct;
    const std::string text = refused.error().with_advice();
    EXPECT_NE(text.find("the finger does not stay deflected under a constant command"), std::string::npos)
        << text;
    EXPECT_EQ(text.find("sign"), std::string::npos) << text;
  }
  EXPECT_TRUE(check(modes(0.35), FeedforwardKind::planned));
  EXPECT_TRUE(check(modes(0.35), FeedforwardKind::none));
  const auto backwards = check(modes(0.2), FeedforwardKind::none);
  ASSERT_FALSE(backwards);
  EXPECT_NE(backwards.error().with_advice().find("turn the sign of the sensor"), std::string::npos);
}

TEST(Invertibility, ARefusalWithoutInverseAdvisesPlannedOrNone) {
  const auto refused = check(model::with_block({}, {model::block_type<model::LinearModes>(), {0.1}}),
                             FeedforwardKind::full_model);
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().with_advice(),
      "the model contains `linear_modes`, which has no inverse; use feedforward `planned` or `none` with "
      "this model");
}

TEST(Invertibility, ExtraLatencyHasBounds) {
  const model::Model twin = model_named("bench_twin");
  EXPECT_FALSE(check_feedforward(twin, {FeedforwardKind::full_model, -0.001}, limits, sim::tick_s));
  EXPECT_FALSE(check_feedforward(twin, {FeedforwardKind::full_model, std::nan("")}, limits, sim::tick_s));
  EXPECT_TRUE(check_feedforward(twin, {FeedforwardKind::full_model, 0.002}, limits, sim::tick_s));
  EXPECT_TRUE(check_feedforward(twin, {FeedforwardKind::full_model, 1}, limits, sim::tick_s));
  EXPECT_FALSE(check_feedforward(twin, {FeedforwardKind::full_model, 1.001}, limits, sim::tick_s));
}

}  // namespace
}  // namespace softgrip::control::invertibility_test
