// Tests a rig with a pressure range from -40 to 60 kPa and a rest pressure of 0 kPa. Every return to rest
// must end at 0 kPa, from a positive and from a negative pressure.

#include <gtest/gtest.h>

#include <string>

#include "control/sequences/sequence_file.h"
#include "tests/control/rig_fixture.h"

namespace softgrip::control::vacuum_rig_test {
namespace {

class VacuumRig : public testing::Test {
 protected:
  /// Runs a grip until the fingers hold a part at -30 kPa.
  void hold_vacuum(SimulatedRig& rig) {
    ASSERT_TRUE(rig.start_until_step(grip, 1));
    ASSERT_EQ(rig.result(0), GripResult::holding);
    ASSERT_NEAR(rig.board_kpa(0), -30, 1e-9);
  }
  static double command(const SimulatedRig& rig) { return rig.output().channels[0].command_kpa; }
  /// Returns the reason why this rig refuses a sequence of these steps. Returns "" if the rig accepts the
  /// sequence.
  std::string refusal(const std::string& steps) const {
    document::Problems problems;
    const auto sequence =
        read_sequence(document::parse("test.yaml", "name: x\nsteps:\n" + steps, problems), problems);
    if (sequence) static_cast<void>(prepare(*sequence, settings, problems));
    return problems.format();
  }

  RigSettings settings = vacuum_settings();
  PreparedSequence grip = vacuum_grip(settings);
};

TEST_F(VacuumRig, StartsAndIdlesAtRest) {
  SimulatedRig rig(settings);
  EXPECT_EQ(rig.output().channels[0].command_kpa, 0);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.run(2);
  EXPECT_EQ(rig.board_kpa(0), 0);
  EXPECT_EQ(rig.output().channels[0].safe_kpa, 0);
  EXPECT_EQ(rig.output().under_pressure, 0U);
}

TEST_F(VacuumRig, AVacuumGripHoldsAndReleasesToRestPressure) {
  SimulatedRig rig(settings);
  hold_vacuum(rig);
  EXPECT_EQ(rig.output().channels[0].evidence, GripEvidence::pressure);
  ASSERT_TRUE(rig.run_until_step(2, 10));
  ASSERT_TRUE(rig.run_until(State::idle, 10));
  EXPECT_EQ(rig.result(0), GripResult::released);
  EXPECT_EQ(rig.board_kpa(0), 0);
  EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U);
}

TEST_F(VacuumRig, VentAndReleaseReturnToRestWithinTheSlewLimit) {
  for (const Request::Kind kind : {Request::Kind::vent, Request::Kind::release}) {
    SimulatedRig rig(settings);  // SimulatedRig checks the slew limits in each tick
    hold_vacuum(rig);
    rig.request(kind);
    ASSERT_TRUE(rig.run_until(State::idle, 10));
    EXPECT_EQ(rig.board_kpa(0), 0);
    EXPECT_EQ(rig.result(0), GripResult::released);
  }
}

TEST_F(VacuumRig, AVacuumHeldAfterAStopIsReported) {
  settings.safety.safe_action.fill(SafeAction::hold);
  const PreparedSequence held = vacuum_grip(settings);
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start_until_step(held, 1));
  rig.request(Request::Kind::stop);
  ASSERT_TRUE(rig.run_until(State::idle, 2));
  EXPECT_EQ(rig.output().under_pressure, 3U);
  EXPECT_NEAR(command(rig), -30, 1e-9);
  rig.request(Request::Kind::release);
  ASSERT_TRUE(rig.run_until(State::stopping, 1));
  ASSERT_TRUE(rig.run_until(State::idle, 2));
  EXPECT_EQ(rig.output().under_pressure, 0U);
  EXPECT_EQ(command(rig), 0);
}

TEST_F(VacuumRig, ALostVacuumIsReportedAsPartLost) {
  SimulatedRig rig(settings);
  hold_vacuum(rig);
  rig.fault[0].pressure_offset_kpa = 10;
  ASSERT_TRUE(rig.run_until(State::idle, 10));
  EXPECT_EQ(rig.result(0), GripResult::part_lost);
  EXPECT_EQ(rig.board_kpa(0), 0);
}

TEST_F(VacuumRig, AMissingVacuumIsReportedAsNoPart) {
  SimulatedRig rig(settings);
  rig.fault[0].pressure_offset_kpa = rig.fault[1].pressure_offset_kpa = 10;
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::start, &grip);
  ASSERT_TRUE(rig.run_until(State::running, 12));
  ASSERT_TRUE(rig.run_until(State::idle, 20));
  EXPECT_EQ(rig.result(0), GripResult::no_part);
}

TEST_F(VacuumRig, AStopBelowRestContinuesFromTheBoardOutputs) {
  settings.safety.safe_action.fill(SafeAction::hold);
  const PreparedSequence held = vacuum_grip(settings);
  for (const double outputs_kpa : {-4.0, 0.0, 25.0}) {
    SimulatedRig rig(settings);
    ASSERT_TRUE(rig.start_until_step(held, 1));
    rig.outputs_kpa = {outputs_kpa, outputs_kpa};
    rig.request(Request::Kind::stop);
    rig.tick();
    const double rise_kpa = settings.channels[0].limits.slew_up_kpa_per_s / settings.rate_hz;
    EXPECT_LE(command(rig), -30 + rise_kpa + 1e-9) << "a command that was already sent may still be written";
    rig.run(1);
    EXPECT_EQ(command(rig), std::min(outputs_kpa, 0.0)) << "the command never passes the rest pressure";
  }
}

TEST_F(VacuumRig, AWatchdogTripSetsTheCommandToRest) {
  SimulatedRig rig(settings);
  hold_vacuum(rig);
  rig.bus_fault = FaultCode::board_watchdog_tripped;
  rig.outputs_kpa = {0, 0};
  rig.tick();
  EXPECT_EQ(rig.output().state, State::faulted);
  EXPECT_EQ(command(rig), 0);
  EXPECT_EQ(rig.output().channels[0].safe_kpa, 0);
}

TEST_F(VacuumRig, AReleaseFromVacuumDoesNotCrossTheRestPressure) {
  const PreparedSequence release = sequence_of(
      "name: x\nsteps:\n"
      "  - move: {pressure_kpa: -20, duration_s: 0.2}\n"
      "  - release: {pressure_kpa: 15, duration_s: 0.2, purge_s: 0.1, timeout_s: 5, on_fail: vent}\n",
      settings);
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.start_until_step(release, 1));
  while (rig.output().state == State::running) {
    rig.tick();
    ASSERT_LE(command(rig), 0) << "the command does not cross the rest pressure";
  }
  EXPECT_EQ(command(rig), 0);
}

TEST_F(VacuumRig, DetectionBelowRestIsRefused) {
  const std::string rest = ", settle_s: 0.2, timeout_s: 5, on_fail: vent}\n";
  const std::string detection = ", verify: {by: detection, window_s: 0.2}" + rest;
  EXPECT_NE(
      refusal("  - grip: {pressure_kpa: -20, duration_s: 1" + detection).find("below its rest pressure"),
      std::string::npos);
  EXPECT_NE(
      refusal("  - grip: {displacement_mm: -6, duration_s: 1" + detection).find("below its rest pressure"),
      std::string::npos);
  EXPECT_EQ(refusal("  - grip: {pressure_kpa: 20, duration_s: 1" + detection), "");
}

TEST_F(VacuumRig, ContactAndGrippingPressureBelowRestAreRefused) {
  const auto below = [&](const std::string& step) {
    return refusal("  - " + step + "}\n").find("moves channel 'left' below its rest pressure (0 kPa)") !=
           std::string::npos;
  };
  const std::string squeeze =
      ", duration_s: 1, squeeze_kpa: 5, squeeze_speed_kpa_per_s: 5, settle_s: 0.2, timeout_s: 5, on_fail: "
      "vent, "
      "verify: {by: position, window_s: 0.2, displacement_min_mm: -20, displacement_max_mm: 20}";
  EXPECT_TRUE(below("grip: {pressure_kpa: -20" + squeeze));
  EXPECT_FALSE(below("grip: {pressure_kpa: 20" + squeeze));
  for (const auto& [step, highest_kpa] : std::vector<std::pair<std::string, double>>{
           {"move: {pressure_kpa: -20, duration_s: 1", -20},
           {"move: {pressure_kpa: 20, duration_s: 1", 20},
           {"move: {displacement_mm: -6, duration_s: 1", -20},
           {"track: {mean_mm: -6, amplitude_mm: 2, frequency_hz: 0.1, cycles: 1", -10},
           {"track: {mean_mm: -1, amplitude_mm: 8, frequency_hz: 0.1, cycles: 1", 20},
           {"pressure: {points: [{time_s: 0, pressure_kpa: -20}, {time_s: 1, pressure_kpa: -5}]", -5},
           {"pressure: {points: [{time_s: 0, pressure_kpa: -20}, {time_s: 1, pressure_kpa: 5}]", 5}}) {
    EXPECT_EQ(below(step + ", on_contact: hold"), highest_kpa < 0) << step;
    EXPECT_FALSE(below(step + ", on_contact: ignore")) << step;
    EXPECT_FALSE(below(step)) << step << ": without on_contact, the step must not be refused";
  }
}

TEST_F(VacuumRig, AVerificationBoundMetAtRestIsRefused) {
  const auto verified_by = [&](const std::string& bound) {
    return refusal("  - grip: {pressure_kpa: -20, duration_s: 1, verify: {by: pressure, window_s: 0.2, " +
                   bound + "}, settle_s: 0.2, timeout_s: 5, on_fail: vent}\n");
  };
  EXPECT_NE(verified_by("pressure_min_kpa: -25").find("already has at rest, without a grip (0 kPa)"),
            std::string::npos);
  EXPECT_NE(verified_by("pressure_max_kpa: 5").find("already has at rest, without a grip (0 kPa)"),
            std::string::npos);
  EXPECT_NE(verified_by("pressure_min_kpa: -25, pressure_max_kpa: -5").find("not both"), std::string::npos);
  EXPECT_EQ(verified_by("pressure_max_kpa: -15"), "");
}

TEST_F(VacuumRig, APressureMaximumBelowRestIsRefused) {
  const auto bounded_by = [&](const std::string& bound) {
    return refusal("  - move: {pressure_kpa: -30, duration_s: 1, pressure_max_kpa: " + bound + "}\n");
  };
  EXPECT_NE(bounded_by("-20").find("below the rest pressure of channel 'left' (0 kPa)"), std::string::npos);
  EXPECT_EQ(bounded_by("0"), "");
}

/// All steps of the sequence pick_stone are above the rest pressure. An upper pressure limit of a step must
/// not make the rig apply a vacuum to a finger.
TEST_F(VacuumRig, StepsAboveRestWorkAsOnARigWithoutVacuum) {
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  SimulatedRig rig(settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start_until_step(pick, 2));
  EXPECT_EQ(rig.result(0), GripResult::holding);
  ASSERT_TRUE(rig.run_until(State::idle, 30));
  EXPECT_EQ(rig.result(0), GripResult::released);
  EXPECT_EQ(rig.board_kpa(0), 0);
}

}  // namespace
}  // namespace softgrip::control::vacuum_rig_test
