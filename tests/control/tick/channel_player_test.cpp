// Tests the demand of one channel in the tick in which a step begins, and the reaction of the channel to a
// contact.

#include "control/tick/channel_player.h"

#include <gtest/gtest.h>

#include "control/tick/sequence.h"

namespace softgrip::control::channel_player_test {
namespace {

constexpr ChannelTraits traits{.margin_mm = 1, .rest_kpa = 0, .preview_s = 0.1, .displacement_used = true};

Step step_of(StepKind kind) {
  Step step;
  step.kind = kind;
  step.target = {Target::Quantity::displacement_mm, 5, false, 10, 0};
  step.sine = {5, 1, 0.1, 1};
  step.profile.points = {{0, 12}, {0.5, 30}, {2, 20}};
  step.hold_s = 1;
  step.reverify_every_s = 0.2;
  return step;
}

/// Returns the output of a channel whose displacement is `shortfall_mm` smaller than the displacement in free
/// motion.
ChannelOutput short_by(double shortfall_mm) {
  ChannelOutput seen;
  seen.validity = model::Validity::valid;
  seen.displacement_mm = 8;
  seen.residual_mm = -shortfall_mm;
  return seen;
}

double reference_mm(const ChannelDemand& demand) {
  return demand.reference->value_at(demand.time_s);
}

/// Returns a player whose finger touches a part and has no grip result yet.
ChannelPlayer touching(const Step& closing) {
  ChannelPlayer player(traits);
  player.reset();
  player.begin(closing, nullptr, 0, short_by(2));
  (void)player.tick(0.01, short_by(2));
  EXPECT_TRUE(player.touching());
  return player;
}

// Before a failed step is repeated, the channel returns to where the step began, and not to where an earlier
// step began.
TEST(ChannelPlayer, BacksOffAProfileToThePressureAtWhichItBegan) {
  ChannelPlayer player(traits);
  player.reset();
  ChannelOutput seen = short_by(0);
  const Step move = step_of(StepKind::move), profile = step_of(StepKind::pressure);
  player.begin(move, nullptr, 0, seen);
  seen.command_kpa = 17;
  player.begin(profile, nullptr, 5, seen);
  (void)player.tick(5.25, seen);
  EXPECT_EQ(player.demand(5.25).pressure_kpa, 21);
  seen.command_kpa = 21;
  player.back_off(5.25, seen);
  for (double time_s = 5.25; time_s < 6; time_s += 0.05) (void)player.tick(time_s, seen);
  EXPECT_EQ(player.demand(6).mode, ChannelDemand::Mode::pressure);
  EXPECT_NEAR(player.demand(6).pressure_kpa, 17, 1e-9);
}

TEST(ChannelPlayer, BacksOffATrackToTheDisplacementAtWhichItBegan) {
  ChannelPlayer player(traits);
  player.reset();
  const ChannelOutput seen = short_by(0);
  Step move = step_of(StepKind::move);
  move.target.value = 4;  // the sine begins there
  const Step track = step_of(StepKind::track);
  player.begin(move, nullptr, 0, seen);
  (void)player.tick(5, seen);
  ASSERT_NEAR(reference_mm(player.demand(5)), 4, 1e-9) << "the target of the move";
  player.begin(track, nullptr, 5, seen);
  (void)player.tick(7.5, seen);
  ASSERT_GT(reference_mm(player.demand(7.5)), 4.5);
  player.back_off(7.5, seen);
  for (double time_s = 7.5; time_s < 12; time_s += 0.05) (void)player.tick(time_s, seen);
  EXPECT_EQ(player.demand(12).mode, ChannelDemand::Mode::displacement);
  EXPECT_NEAR(reference_mm(player.demand(12)), 4, 1e-9);
}

TEST(ChannelPlayer, AProfileBeginsWithItsFirstPressure) {
  ChannelPlayer player(traits);
  player.reset();
  const Step step = step_of(StepKind::pressure);
  player.begin(step, nullptr, 7, short_by(0));
  EXPECT_EQ(player.demand(7).mode, ChannelDemand::Mode::pressure);
  EXPECT_EQ(player.demand(7).pressure_kpa, 12);
  (void)player.tick(7, short_by(0));
  EXPECT_EQ(player.demand(7).pressure_kpa, 12);
  (void)player.tick(7.25, short_by(0));
  EXPECT_EQ(player.demand(7.25).pressure_kpa, 21);
}

// While the finger presses on a part, the integral of the feedback would increase the gripping pressure.
// The integral is therefore held during a contact in grip and hold steps. After the grip result HOLDING, the
// integral is held in all steps, until the contact ends.
TEST(ChannelPlayer, ContactHoldsFeedbackOnlyWhileGrippingOrHolding) {
  const Step grip = step_of(StepKind::grip);
  for (const StepKind kind : {StepKind::move, StepKind::grip, StepKind::hold, StepKind::release,
                              StepKind::track, StepKind::pressure}) {
    SCOPED_TRACE(name_of(kind));
    const bool closing = kind == StepKind::grip || kind == StepKind::hold;
    const Step next = step_of(kind);

    ChannelPlayer player = touching(grip);
    player.begin(next, nullptr, 1, short_by(2));
    EXPECT_EQ(player.demand(1).feedback_held, closing) << "the finger touches a part";

    player = touching(grip);
    player.answer_holding(0.02);
    player.begin(next, nullptr, 1, short_by(2));
    EXPECT_TRUE(player.demand(1).feedback_held) << "the finger holds a part";

    (void)player.tick(1.01, short_by(0));
    EXPECT_FALSE(player.demand(1.01).feedback_held) << "the contact has ended";
  }
}

/// Returns the output of a channel whose finger touches a part at the pressure `command_kpa`. In free motion,
/// the finger would have the same displacement at `free_kpa`.
ChannelOutput touching_under(double command_kpa, double free_kpa) {
  ChannelOutput seen = short_by(2);
  seen.command_kpa = command_kpa;
  seen.free_kpa = free_kpa;
  return seen;
}

TEST(ChannelPlayer, ContactIsDetectedOnlyAboveTheRestPressure) {
  Step move = step_of(StepKind::move);
  move.target = {Target::Quantity::pressure_kpa, 30, false, 0, 2};
  move.on_contact = OnContact::hold;
  ChannelPlayer player(traits);
  player.reset();
  player.begin(move, nullptr, 0, touching_under(-20, -25));
  for (int i = 1; i <= 20; ++i) (void)player.tick(0.01 * i, touching_under(-20 + i, -25));
  EXPECT_FALSE(player.stopped_by_contact()) << "the pressure is still below the rest pressure";
  EXPECT_EQ(player.take_contact(), std::nullopt);
  for (int i = 21; i <= 24; ++i) (void)player.tick(0.01 * i, touching_under(-20 + i, 1));
  EXPECT_TRUE(player.stopped_by_contact()) << "the pressure is above the rest pressure";
  EXPECT_EQ(player.take_contact(), OnContact::hold);
}

TEST(ChannelPlayer, GrippingPressureNeverFallsBelowRest) {
  Step grip = step_of(StepKind::grip);
  grip.target = {Target::Quantity::pressure_kpa, 40, false, 0, 2};
  grip.squeeze = {5, 10};
  ChannelPlayer player(traits);
  player.reset();
  player.begin(grip, nullptr, 0, touching_under(10, 8));
  for (int i = 1; i <= 5; ++i) (void)player.tick(0.01 * i, touching_under(10, 8));
  ASSERT_EQ(player.take_contact(), OnContact::squeeze);
  (void)player.tick(0.06, touching_under(10, 8));
  EXPECT_NEAR(player.demand(0.06).pressure_kpa, 10.3, 0.2);
  (void)player.tick(0.07, touching_under(10, -20));  // an external force pushes the finger back beyond its
                                                     // rest position
  EXPECT_EQ(player.demand(0.07).pressure_kpa, 0);
}

}  // namespace
}  // namespace softgrip::control::channel_player_test
