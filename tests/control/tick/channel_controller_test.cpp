#include "control/tick/channel_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/control/simulated_finger.h"

namespace softgrip::control::channel_controller_test {
namespace {

using sim::tick_ns;
using sim::tick_s;
using sim::twin_settings;
using Mode = ChannelDemand::Mode;

/// Runs a controller and a simulated finger with the same clock.
class Rig {
 public:
  explicit Rig(const ChannelSettings& settings, double noise_mm = 0, std::uint64_t seed = 1)
      : Rig(settings, settings.model, noise_mm, seed) {}
  Rig(const ChannelSettings& settings, const model::Model& truth, double noise_mm, std::uint64_t seed)
      : controller(settings, tick_s), finger(truth, noise_mm, seed) {
    controller.start(0, last);
    exchange();
  }

  /// Runs one tick with the present demand. The exchange with the finger follows the tick immediately, as on
  /// a real rig.
  ChannelOutput tick() {
    now += tick_ns;
    input.now = now;
    input.demand.time_s = time_s();
    controller.tick(input, last);
    exchange();
    return last;
  }
  void run(
      double seconds, const std::function<void()>& each = [] {}) {
    for (int i = 0; i < std::lround(seconds / tick_s); ++i) {
      tick();
      each();
    }
  }
  void track(const Reference& reference) {
    input.demand.mode = Mode::displacement;
    input.demand.reference = &reference;
  }
  void press(double pressure_kpa) {
    input.demand.mode = Mode::pressure;
    input.demand.pressure_kpa = pressure_kpa;
  }
  [[nodiscard]] double time_s() const { return static_cast<double>(now) * 1e-9; }
  /// Returns the tracking error [mm]: reference minus true displacement.
  [[nodiscard]] double error_mm() const {
    return input.demand.reference->at(time_s() + tick_s).value - finger.displacement_mm();
  }

  ChannelController controller;
  sim::SimulatedFinger finger;
  ChannelInput input;
  ChannelOutput last;
  Nanoseconds now = 1'000'000'000'000;

 private:
  void exchange() { input.reading = finger.write(last.command_kpa, now); }
};

Reference ramp_and_sine(double from_s) {
  Reference reference;
  reference.start(from_s, 0);
  (void)reference.hold_for(0.2);  // longer than the preview of the feedforward, so that the finger does not
                                  // start before 0.2 s
  (void)reference.ramp_for(6, 2);
  (void)reference.hold_for(1);
  (void)reference.sine(13, 7, 0.1, 3);
  return reference;
}

TEST(ChannelController, TracksBenchTwinWithin5Micrometres) {
  Rig rig(twin_settings());
  const Reference reference = ramp_and_sine(rig.time_s());
  rig.track(reference);
  double worst = 0;
  rig.run(33, [&] { worst = std::max(worst, std::abs(rig.error_mm())); });
  EXPECT_LT(worst, 5e-3);
  EXPECT_LT(std::abs(rig.last.residual_mm), 1e-3);
}

TEST(ChannelController, FeedbackHalvesTheErrorOfAnInaccurateModel) {
  ChannelSettings settings = twin_settings();
  const model::Model finger = settings.model;
  auto values = model::flat_values(settings.model);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool whole = model::parameter_spec(settings.model, i).whole;
    values[i] *= whole ? 1 : i % 2 == 0 ? 1.05 : 0.95;
  }
  settings.model = model::with_values(settings.model, values);
  const auto tracked = [&](const PidSettings& pid) {
    settings.pid = pid;
    Rig rig(settings, finger, 0.03, 7);
    const Reference reference = ramp_and_sine(rig.time_s());
    rig.track(reference);
    double square = 0;
    rig.run(13);
    rig.run(20, [&] { square += rig.error_mm() * rig.error_mm() / 4000; });
    return std::sqrt(square);
  };
  const double with_feedback = tracked(settings.pid);
  const double alone = tracked({});
  EXPECT_LT(with_feedback, 0.5 * alone);
}

TEST(ChannelController, EveryChangeOfModeIsBumpless) {
  Rig rig(twin_settings(), 0.02);
  Reference reference;
  double before = 0;
  // A change of the control mode may change the command by at most 1 kPa in one tick. This is half of the
  // change that the slew limit permits.
  const auto expect_smooth = [&](const char* what) {
    rig.run(0.05, [&] {
      EXPECT_NEAR(rig.last.command_kpa, before, 1.0) << what;
      before = rig.last.command_kpa;
    });
  };
  rig.press(20);
  rig.run(1.5);
  before = rig.last.command_kpa;
  reference.start(rig.time_s(), rig.last.displacement_mm);
  rig.track(reference);
  rig.tick();
  EXPECT_NEAR(rig.last.command_kpa, before, 1e-9)
      << "the change from pressure mode to displacement mode causes no step although the finger creeps";
  expect_smooth("after the start of tracking");
  EXPECT_TRUE(reference.ramp_to(15, 10));
  rig.run(0.4);
  before = rig.last.command_kpa;
  rig.input.demand.mode = Mode::hold;
  rig.tick();
  EXPECT_EQ(rig.last.command_kpa, before);
  EXPECT_EQ(rig.last.feedback_kpa, 0);
  EXPECT_TRUE(std::isnan(rig.last.reference_mm));
  rig.run(0.7);
  reference.start(rig.time_s(), rig.last.displacement_mm);
  rig.track(reference);
  rig.tick();
  EXPECT_NEAR(rig.last.command_kpa, before, 1e-9)
      << "the change from hold to displacement mode causes no step";
  expect_smooth("after hold");
}

TEST(ChannelController, HeldFeedbackResumesWithoutAStep) {
  Rig rig(twin_settings());
  const Reference reference = ramp_and_sine(rig.time_s());
  rig.track(reference);
  rig.run(5);
  const double held = rig.last.feedback_kpa;
  rig.input.demand.feedback_held = true;
  rig.run(1, [&] { EXPECT_EQ(rig.last.feedback_kpa, held); });
  const double before = rig.last.command_kpa;
  rig.input.demand.feedback_held = false;
  rig.tick();
  EXPECT_NEAR(rig.last.command_kpa, before, 0.1);
}

TEST(ChannelController, VentGoesDownAtTheSlewLimit) {
  ChannelSettings settings = twin_settings();
  settings.limits.slew_down_kpa_per_s = 100;
  Rig rig(settings);
  rig.press(40);
  rig.run(1);
  EXPECT_EQ(rig.last.command_kpa, 40);
  rig.input.demand.mode = Mode::vent;
  rig.tick();
  EXPECT_NEAR(rig.last.command_kpa, 39.5, 1e-9);
  EXPECT_TRUE(rig.last.slewing);
  rig.run(0.4);
  EXPECT_EQ(rig.last.command_kpa, 0);
}

TEST(ChannelController, APressureBoundDoesNotStopTheRiseToRest) {
  ChannelSettings settings = twin_settings();
  settings.limits.pressure_min_kpa = -40;
  Rig rig(settings);
  for (const Mode mode : {Mode::vent, Mode::pressure}) {
    rig.input.demand = {};
    rig.press(-30);
    rig.run(1);
    ASSERT_EQ(rig.last.command_kpa, -30);
    rig.press(0);
    rig.input.demand.mode = mode;
    rig.input.demand.pressure_max_kpa = -20;
    rig.input.demand.squeeze_max_kpa = 1;
    bool bound = false;
    rig.run(1, [&] {
      bound = bound || rig.last.bound_by == BindingLimit::step_pressure ||
              rig.last.bound_by == BindingLimit::step_squeeze;
    });
    EXPECT_FALSE(bound);
    EXPECT_EQ(rig.last.command_kpa, 0);
  }
}

TEST(ChannelController, DisplacementModeWithoutReferenceHoldsTheCommand) {
  Rig rig(twin_settings());
  rig.press(10);
  rig.run(0.5);
  rig.input.demand.mode = Mode::displacement;
  rig.input.demand.reference = nullptr;
  rig.tick();
  EXPECT_EQ(rig.last.command_kpa, 10);
  rig.press(std::nan(""));
  rig.tick();
  EXPECT_EQ(rig.last.command_kpa, 10);
  EXPECT_TRUE(rig.last.request_invalid);
}

TEST(ChannelController, TheReferenceStaysInsideTheDisplacementRange) {
  ChannelSettings settings = twin_settings();
  settings.limits.displacement_max_mm = 10;
  Rig rig(settings);
  Reference reference;
  reference.start(rig.time_s(), 0);
  (void)reference.ramp_for(20, 3);
  rig.track(reference);
  double highest = 0;
  rig.run(6, [&] { highest = std::max(highest, rig.finger.displacement_mm()); });
  EXPECT_TRUE(rig.last.reference_clamped);
  EXPECT_EQ(rig.last.reference_mm, 10);
  EXPECT_LT(highest, 10.3);
  EXPECT_FALSE(rig.last.displacement_beyond);
  settings.limits.displacement_max_mm = 5;
  Rig other(settings);
  other.press(30);
  other.run(3);
  EXPECT_TRUE(other.last.displacement_beyond);
}

TEST(ChannelController, AGapInTheReadingsHoldsFeedbackThenTrackingResumes) {
  Rig rig(twin_settings(), 0.02);
  const Reference reference = ramp_and_sine(rig.time_s());
  rig.track(reference);
  rig.run(6);
  const double held = rig.last.feedback_kpa;
  rig.run(0.2, [&] { rig.input.reading.validity = model::Validity::sensor_error; });
  EXPECT_EQ(rig.last.validity, model::Validity::sensor_error);
  EXPECT_NEAR(rig.last.feedback_kpa, held, 0.2);
  EXPECT_TRUE(std::isnan(rig.last.residual_mm));
  rig.run(1);
  EXPECT_LT(std::abs(rig.error_mm()), 0.05);
}

TEST(ChannelController, ResynchronisingRemovesTheModelOffset) {
  // The controller restarts while the finger is inflated and still creeps.
  ChannelSettings settings = twin_settings();
  Rig rig(settings, 0.02);
  rig.press(30);
  rig.run(5);
  rig.controller.start(rig.last.command_kpa, rig.last);
  rig.input.demand.mode = Mode::hold;
  rig.tick();
  const double off = rig.last.residual_mm;
  EXPECT_GT(std::abs(off), 0.3)
      << "at the start, the state of the model does not include the creep of the finger";
  rig.input.resynchronise = true;
  int ticks = 0;
  while (!rig.tick().synchronised && ticks < 1000) ++ticks;
  EXPECT_LT(ticks * tick_s, 1);
  EXPECT_NEAR(rig.last.residual_mm, 0, 0.1);
  EXPECT_NEAR(rig.last.offset_mm, off, 0.3);
  rig.input.resynchronise = false;
  const double before = rig.last.command_kpa;
  Reference reference;
  reference.start(rig.time_s(), rig.last.displacement_mm);
  rig.track(reference);
  rig.tick();
  EXPECT_NEAR(rig.last.command_kpa, before, 1e-9);
  rig.run(2);
  EXPECT_NEAR(rig.error_mm(), 0, 0.1);
}

TEST(ChannelController, ModelHealthDetectsAChangedFingerInFreeMotion) {
  ChannelSettings settings = twin_settings();
  settings.health.model_error_mm = 0.05;
  model::Model weak = settings.model;
  auto values = model::flat_values(weak);
  values[model::find_path(weak, "kelvin_voigt.k2_kpa_per_mm").value()] *= 1.4;
  weak = model::with_values(weak, values);
  Rig rig(settings, weak, 0.03, 5);
  const Reference reference = ramp_and_sine(rig.time_s());
  rig.track(reference);
  int changes = 0;
  rig.run(33, [&] { changes += rig.last.health_changed ? 1 : 0; });
  EXPECT_GE(rig.last.health, HealthState::suspect);
  EXPECT_GE(changes, 2);

  Rig touching(settings, weak, 0.03, 5);
  touching.track(reference);
  touching.input.free_motion = false;
  touching.run(33);
  EXPECT_EQ(touching.last.health, HealthState::unknown)
      << "contact with an object is not an error of the model";
}

TEST(ChannelController, TheModelCatchesUpAfterMissedCycles) {
  Rig rig(twin_settings());
  const Reference reference = ramp_and_sine(rig.time_s());
  rig.track(reference);
  rig.run(5);
  // For three periods, the controller does not run, and the board holds its output.
  for (int i = 0; i < 3; ++i) {
    rig.now += tick_ns;
    rig.input.reading = rig.finger.write(rig.last.command_kpa, rig.now);
  }
  rig.run(0.5);
  EXPECT_LT(std::abs(rig.last.residual_mm), 2e-3);
  rig.run(2);
  EXPECT_LT(std::abs(rig.error_mm()), 0.02);
}

TEST(ChannelController, AnUnusedDisplacementIsIgnored) {
  ChannelSettings settings = twin_settings();
  settings.displacement_used = false;
  settings.limits.displacement_max_mm = 1;
  Rig rig(settings);
  rig.press(30);
  rig.run(3);
  EXPECT_EQ(rig.last.command_kpa, 30);
  EXPECT_FALSE(rig.last.displacement_beyond);
  EXPECT_EQ(rig.last.health, HealthState::unknown);
  rig.input.resynchronise = true;
  EXPECT_TRUE(rig.tick().synchronised);
}

// For arbitrary demands and readings, the command must be a finite number within its range and its slew
// limits.
TEST(ChannelController, LimitsAreNeverExceededUnderRandomDemands) {
  for (const FeedforwardKind kind :
       {FeedforwardKind::none, FeedforwardKind::bouc_wen, FeedforwardKind::full_model}) {
    const unsigned seed = 31337 + static_cast<unsigned>(kind);
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    ChannelSettings settings = twin_settings();
    settings.feedforward.kind = kind;
    settings.pid = {20, 200, 0.5, 0.005, 1, AntiWindup::none, 1};
    Rig rig(settings, 0.5, seed);
    Reference reference;
    std::uniform_real_distribution<double> any(-50, 100);
    const double wild[] = {std::nan(""), 1e308, -1e308, std::numeric_limits<double>::infinity()};
    double last = 0;
    for (int i = 0; i < 20000; ++i) {
      if (random() % 50 == 0) {
        rig.input.demand.mode = static_cast<Mode>(random() % 4);
        rig.input.demand.reference = random() % 10 == 0 ? nullptr : &reference;
        rig.input.demand.pressure_kpa = random() % 5 == 0 ? wild[random() % 4] : any(random);
        rig.input.demand.feedback_held = random() % 4 == 0;
        rig.input.resynchronise = random() % 4 == 0;
        reference.start(rig.time_s(), any(random));
        (void)reference.ramp_for(any(random), 0.01 + 0.01 * static_cast<double>(random() % 100));
      }
      if (random() % 20 == 0) rig.input.reading.displacement_mm = wild[random() % 4];
      if (random() % 20 == 0) rig.input.reading.validity = static_cast<model::Validity>(random() % 7);
      if (random() % 500 == 0) rig.now += tick_ns * static_cast<Nanoseconds>(random() % 2000);
      const double now = rig.tick().command_kpa;
      ASSERT_GE(now, 0) << i;
      ASSERT_LE(now, 60) << i;
      ASSERT_LE(std::abs(now - last), 400 * tick_s * (1 + 1e-9)) << i;
      last = now;
    }
  }
}

TEST(ChannelController, ARefusedFeedforwardHasNoPreview) {
  ChannelSettings settings = twin_settings();
  settings.model = sim::model_named("zhang2025");
  ChannelController controller(settings, tick_s);
  EXPECT_EQ(controller.preview_s(), 0);
}

}  // namespace
}  // namespace softgrip::control::channel_controller_test
