// Injects every fault in every phase. Each fault must be latched within its time limit. The outputs must then
// take the configured safe action. No motion may restart until a client commands it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <tuple>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::fault_reaction_test {
namespace {

struct FaultCase {
  const char* name;
  FaultCode code;
  std::uint32_t bound_cycles;
  std::function<void(SimulatedRig&)> inject;
  std::function<void(SimulatedRig&)> mend;
  bool always_vents = false;
};

std::function<void(SimulatedRig&)> validity(std::optional<model::Validity> value) {
  return [value](SimulatedRig& rig) { rig.fault[1].validity = value; };
}

RigSettings that_watches_all(RigSettings rig) {
  rig.faults.overrun_cycles = 10;
  rig.faults.pressure_cycles = 10;
  rig.faults.pressure_tolerance_kpa = 5;
  rig.faults.pressure_delay_s = 0.3;
  return rig;
}

const RigSettings& base() {
  static const RigSettings settings = that_watches_all(two_finger_settings());
  return settings;
}

std::vector<FaultCase> fault_cases() {
  const FaultSettings& f = base().faults;
  const auto nothing = [](SimulatedRig&) {};
  return {
      {"wire_cut", FaultCode::bus_timed_out, f.bus_down_cycles,
       [](SimulatedRig& rig) { rig.wire_cut = true; }, [](SimulatedRig& rig) { rig.wire_cut = false; }, true},
      {"bus_exception", FaultCode::bus_exception, f.bus_down_cycles,
       [](SimulatedRig& rig) { rig.bus_fault = FaultCode::bus_exception; },
       [](SimulatedRig& rig) { rig.bus_fault = FaultCode::none; }, true},
      {"board_watchdog", FaultCode::board_watchdog_tripped, 1,
       [](SimulatedRig& rig) { rig.bus_fault = FaultCode::board_watchdog_tripped; },
       [](SimulatedRig& rig) { rig.bus_fault = FaultCode::none; }, true},
      {"write_refused", FaultCode::write_refused, 1,
       [](SimulatedRig& rig) { rig.bus_fault = FaultCode::write_refused; },
       [](SimulatedRig& rig) { rig.bus_fault = FaultCode::none; }},
      {"stale", FaultCode::reading_stale, f.invalid_reading_cycles + 1, validity(model::Validity::stale),
       validity(std::nullopt)},
      {"out_of_range", FaultCode::reading_out_of_range, f.invalid_reading_cycles + 1,
       validity(model::Validity::out_of_range), validity(std::nullopt)},
      {"sensor_error", FaultCode::sensor_error, f.invalid_reading_cycles + 1,
       validity(model::Validity::sensor_error), validity(std::nullopt)},
      {"jumped", FaultCode::reading_jumped, f.invalid_reading_cycles + 1,
       [](SimulatedRig& rig) { rig.fault[1].offset_mm = 14; },
       [](SimulatedRig& rig) { rig.fault[1].offset_mm = 0; }},
      {"readback", FaultCode::readback_mismatch, f.readback_cycles,
       [](SimulatedRig& rig) { rig.fault[0].readback_offset_kpa = 12; },
       [](SimulatedRig& rig) { rig.fault[0].readback_offset_kpa = 0; }},
      {"pressure_lost", FaultCode::pressure_not_followed, f.pressure_cycles,
       [](SimulatedRig& rig) { rig.fault[1].pressure_offset_kpa = -70; },
       [](SimulatedRig& rig) { rig.fault[1].pressure_offset_kpa = 0; }},
      {"pressure_monitor", FaultCode::pressure_invalid, f.invalid_reading_cycles,
       [](SimulatedRig& rig) { rig.fault[1].no_pressure = true; },
       [](SimulatedRig& rig) { rig.fault[1].no_pressure = false; }},
      {"emergency_stop", FaultCode::emergency_stop, 1, [](SimulatedRig& rig) { rig.emergency_stop = true; },
       [](SimulatedRig& rig) { rig.emergency_stop = false; }, true},
      {"inputs_lost", FaultCode::inputs_lost, 1, [](SimulatedRig& rig) { rig.inputs_lost = true; },
       [](SimulatedRig& rig) { rig.inputs_lost = false; }, true},
      {"cycles_lost", FaultCode::cycles_lost, 1, [](SimulatedRig& rig) { rig.overrun_cycles = 10; }, nothing},
  };
}

struct PhaseCase {
  const char* name;
  Phase phase;
  int step;  ///< index of the step of the sequence pick_stone; -1: the rig is idle
  double into_s;
};
const std::vector<PhaseCase> phase_cases{{"idle", Phase::idle, -1, 0.5},
                                         {"approaching", Phase::closing, 0, 0.3},
                                         {"gripping", Phase::closing, 1, 0.7},
                                         {"holding", Phase::holding, 2, 1.0},
                                         {"releasing", Phase::releasing, 3, 0.2}};

/// Phases of the sequence vacuum_grip, which moves below the rest pressure and has no approach phase.
const std::vector<PhaseCase> vacuum_phases{{"idle", Phase::idle, -1, 0.5},
                                           {"evacuating", Phase::closing, 0, 0.4},
                                           {"gripping", Phase::closing, 0, 1.2},
                                           {"holding", Phase::holding, 1, 1.0},
                                           {"releasing", Phase::releasing, 2, 0.2}};

using Parameters = std::tuple<std::size_t, std::size_t, SafeAction, bool>;

class FaultReaction : public testing::TestWithParam<Parameters> {
 protected:
  /// Runs a rig with a stone until the rig is in this phase. The test can then inject a fault.
  void reach(SimulatedRig& rig, const PhaseCase& phase) {
    rig.stone(12);
    ASSERT_TRUE(rig.run_until(State::idle, 1));
    rig.run(1.5);  // all transients have ended after 1.5 s, so any later deviation of the pressure is a fault
    if (phase.step >= 0) {
      rig.request(Request::Kind::start, &pick);
      ASSERT_TRUE(rig.run_until_step(static_cast<std::uint16_t>(phase.step), 30));
    }
    rig.run(phase.into_s);
    ASSERT_NE(rig.output().state, State::faulted);
  }

  const bool vacuum = std::get<3>(GetParam());
  RigSettings settings = vacuum ? that_watches_all(vacuum_settings()) : base();
  PreparedSequence pick = vacuum ? vacuum_grip(settings) : example_sequence("pick_stone", settings);
};

TEST_P(FaultReaction, LatchesActsAndStaysUntilAcknowledged) {
  const auto [which, when, action, evacuates] = GetParam();
  const FaultCase fault = fault_cases()[which];
  const PhaseCase& phase = (evacuates ? vacuum_phases : phase_cases)[when];
  settings.safety.safe_action.fill(action == SafeAction::vent ? SafeAction::hold : SafeAction::vent);
  settings.safety.safe_action[static_cast<std::size_t>(phase.phase)] = action;
  SimulatedRig rig(settings);
  ASSERT_NO_FATAL_FAILURE(reach(rig, phase));

  const double before_kpa = rig.output().channels[0].command_kpa;
  fault.inject(rig);
  std::uint32_t cycles = 0;
  while (rig.output().state != State::faulted && cycles < 100) {
    rig.tick();
    ++cycles;
  }
  EXPECT_LE(cycles, fault.bound_cycles);
  EXPECT_EQ(rig.output().first_fault.code, fault.code);
  const double at_latch_kpa = rig.output().channels[0].command_kpa;
  EXPECT_NEAR(at_latch_kpa, before_kpa, 10)
      << "until the fault is latched, the command changes for at most a few cycles";
  if (phase.step >= 0) {
    EXPECT_EQ(rig.result(0), GripResult::error);
  }

  rig.run(1);  // SimulatedRig checks in each tick that no command moves away from the rest pressure
  const bool vents = fault.always_vents || action == SafeAction::vent;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(rig.board_kpa(i), vents ? 0 : at_latch_kpa, 1.5);
  }
  EXPECT_EQ(rig.output().channels[0].safe_kpa, rig.output().channels[0].command_kpa);

  fault.mend(rig);
  rig.run(1);
  EXPECT_EQ(rig.output().state, State::faulted);
  EXPECT_EQ(rig.output().first_fault.code, fault.code);
  rig.request(Request::Kind::start, &pick);
  rig.tick();
  const auto refused = rig.answer(Event::Kind::request_refused);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->detail, Event::Detail(RequestRefusal{RefusalCode::faulted}));

  rig.request(Request::Kind::acknowledge);
  rig.tick();
  EXPECT_TRUE(rig.answer(Event::Kind::fault_acknowledged));
  const double rest_kpa = rig.output().channels[0].command_kpa;
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.run(2);
  EXPECT_EQ(rig.output().state, State::idle);
  EXPECT_EQ(rig.output().channels[0].command_kpa, rest_kpa) << "an acknowledgement moves no finger";
  EXPECT_EQ(rig.result(0), GripResult::none);

  if (rest_kpa != 0) {  // the safe action hold may have kept the grip on a part, so vent the finger before
                        // the next grip
    rig.request(Request::Kind::vent);
    ASSERT_TRUE(rig.run_until(State::idle, 2));
  }
  rig.run(15);
  rig.request(Request::Kind::start, &pick);
  ASSERT_TRUE(rig.run_until(State::running, 12));
  ASSERT_TRUE(rig.run_until(State::idle, 60));
  EXPECT_EQ(rig.result(0), GripResult::released);
}

std::string case_name(const testing::TestParamInfo<Parameters>& test) {
  const bool vacuum = std::get<3>(test.param);
  return std::string(fault_cases()[std::get<0>(test.param)].name) + "_while_" +
         (vacuum ? vacuum_phases : phase_cases)[std::get<1>(test.param)].name + "_" +
         std::string(name_of(std::get<2>(test.param))) + (vacuum ? "_below_rest" : "");
}

INSTANTIATE_TEST_SUITE_P(AllFaultsInAllPhases, FaultReaction,
                         testing::Combine(testing::Range<std::size_t>(0, fault_cases().size()),
                                          testing::Range<std::size_t>(0, phase_cases.size()),
                                          testing::Values(SafeAction::vent, SafeAction::hold),
                                          testing::Bool()),
                         case_name);

class SingleFault : public testing::Test {
 protected:
  RigSettings settings = base();
};

// A fault must be latched after exactly the number of faulty cycles that the rig file states.
TEST_F(SingleFault, FaultsLatchAfterTheConfiguredNumberOfCycles) {
  const auto ticks_until_fault = [&](const auto& inject) {
    SimulatedRig rig(settings);
    EXPECT_TRUE(rig.run_until(State::idle, 1));
    rig.run(1.5);
    inject(rig);
    std::uint32_t ticks = 0;
    while (rig.tick().state != State::faulted && ticks < 1000) ++ticks;
    return ticks + 1;
  };
  EXPECT_EQ(ticks_until_fault([](SimulatedRig& rig) { rig.bus_fault = FaultCode::bus_exception; }),
            settings.faults.bus_down_cycles);
  EXPECT_EQ(ticks_until_fault([](SimulatedRig& rig) { rig.fault[0].readback_offset_kpa = 12; }),
            settings.faults.readback_cycles);
  EXPECT_EQ(
      ticks_until_fault([](SimulatedRig& rig) { rig.fault[0].validity = model::Validity::sensor_error; }),
      settings.faults.invalid_reading_cycles + 1)
      << "the controller uses the reading of the previous tick";
}

// A single correct readback must reset the count of deviating readbacks to 0.
TEST_F(SingleFault, ACorrectReadbackResetsTheMismatchCount) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  for (std::uint32_t i = 0; i < 10 * settings.faults.readback_cycles; ++i) {
    rig.fault[0].readback_offset_kpa = (i + 1) % settings.faults.readback_cycles == 0 ? 0 : 12;
    rig.tick();
  }
  EXPECT_EQ(rig.count(Event::Kind::fault_latched), 0U);
}

TEST_F(SingleFault, AFrozenReadingIsFoundWhileTheCommandMoves) {
  SimulatedRig rig(settings);
  const PreparedSequence track = example_sequence("track_sine", settings);
  ASSERT_TRUE(rig.start(track));
  rig.fault[0].frozen_mm = rig.output().channels[0].displacement_mm;
  ASSERT_TRUE(rig.run_until(State::faulted, 5));
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::reading_frozen);
}

TEST_F(SingleFault, ABurstLineIsAFaultAndNotReportedAsHolding) {
  // The line bursts, and the displacement reading is constant, as if a part had stopped the finger. If the
  // controller did not check the pressure, the grip result would be HOLDING.
  SimulatedRig rig(settings);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(1, 30));
  while (rig.output().state == State::running && rig.time_s() < 60) {
    rig.fault[0].frozen_mm = rig.fault[0].frozen_mm.value_or(rig.plant_mm(0)) + 1e-3 * std::sin(rig.time_s());
    rig.fault[0].pressure_offset_kpa = -rig.board_kpa(0);
    rig.tick();
    ASSERT_NE(rig.result(0), GripResult::holding);
  }
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::pressure_not_followed);
}

TEST_F(SingleFault, PressureFaultIsSuppressedForALimitedTimeAtStart) {
  SimulatedRig rig(settings);
  rig.fault[0].pressure_offset_kpa = 40;
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.run(1);
  EXPECT_EQ(rig.output().state, State::idle);
  rig.run(1);
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::pressure_not_followed)
      << "after the start, the fault is suppressed only for the time in which a finger may deflate";
}

TEST_F(SingleFault, IntermittentCommunicationDoesNotHideABurstLine) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.run(2);
  rig.fault[0].pressure_offset_kpa = 40;
  for (int i = 0; i < 3 * static_cast<int>(settings.faults.pressure_cycles); ++i) {
    rig.wire_cut = i % 3 == 0;
    rig.tick();
  }
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::pressure_not_followed);
}

TEST_F(SingleFault, IntermittentCommunicationDoesNotHideAnInvalidPressureMonitor) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.run(2);
  rig.fault[0].no_pressure = true;
  for (int i = 0; i < 3 * static_cast<int>(settings.faults.invalid_reading_cycles); ++i) {
    rig.wire_cut = i % 3 == 0;
    rig.tick();
  }
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::pressure_invalid);
}

TEST_F(SingleFault, SingleInvalidPressuresDoNotHideABurstLine) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.run(2);
  rig.fault[0].pressure_offset_kpa = 40;
  for (int i = 0; i < 3 * static_cast<int>(settings.faults.pressure_cycles); ++i) {
    rig.fault[0].no_pressure = i % 3 == 0;
    rig.tick();
  }
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::pressure_not_followed);
}

TEST_F(SingleFault, AnUnmeasuredPressureCausesNoFault) {
  for (ChannelSettings& channel : settings.channels) channel.pressure_measured = false;
  SimulatedRig rig(settings);
  rig.fault[0].no_pressure = true;
  rig.fault[1].no_pressure = true;
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until(State::idle, 60));
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::none);
}

TEST_F(SingleFault, ADriftBeyondTheDisplacementLimitsIsAFault) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  while (rig.output().state != State::faulted && rig.fault[1].offset_mm < 60) {
    rig.fault[1].offset_mm += 0.2;
    rig.tick();
  }
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::displacement_beyond_limits);
  const LimitSettings& limits = settings.channels[1].limits;
  EXPECT_NEAR(rig.fault[1].offset_mm, limits.displacement_max_mm + limits.displacement_margin_mm, 1.5);
}

TEST_F(SingleFault, AnUnfitModelIsAFaultOnlyIfConfigured) {
  for (const bool is_fault : {true, false}) {
    settings.faults.model_unfit_is_fault = is_fault;
    SimulatedRig rig(settings);
    const PreparedSequence track = example_sequence("track_sine", settings);
    ASSERT_TRUE(rig.start(track));
    ASSERT_TRUE(rig.run_until_step(1, 10));
    for (int i = 0; i < 4000 && rig.output().state == State::running; ++i) {
      rig.fault[0].offset_mm = std::min(6.0, rig.fault[0].offset_mm + 0.05);
      rig.tick();
    }
    EXPECT_EQ(rig.output().first_fault.code, is_fault ? FaultCode::model_unfit : FaultCode::none);
    EXPECT_GT(rig.count(Event::Kind::model_health_changed), 0U);
  }
}

TEST_F(SingleFault, ANaNCommandIsNotSentAndLatchesAFault) {
  settings.channels[0].pid.kp_kpa_per_mm = std::numeric_limits<double>::quiet_NaN();
  SimulatedRig rig(settings);  // SimulatedRig checks that every command is finite and within its limits
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  const PreparedSequence track = example_sequence("track_sine", settings);
  rig.request(Request::Kind::start, &track);
  ASSERT_TRUE(rig.run_until(State::faulted, 5));
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::not_finite);
}

TEST_F(SingleFault, TheFirstFaultStaysLatchedAndLaterFaultsAreReported) {
  settings.safety.safe_action.fill(SafeAction::hold);
  SimulatedRig rig(settings);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  rig.stone(12);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(2, 20));
  rig.fault[0].validity = model::Validity::sensor_error;
  ASSERT_TRUE(rig.run_until(State::faulted, 1));
  rig.run(0.5);
  EXPECT_GT(rig.board_kpa(0), 20) << "the settings of this rig require that the fault holds the pressure";
  rig.emergency_stop = true;
  rig.run(1);
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::sensor_error);
  EXPECT_EQ(rig.count(Event::Kind::fault_latched), 2U);
  EXPECT_EQ(rig.board_kpa(0), 0)
      << "a second fault can change the reaction from hold to vent, but not from vent to hold";
}

TEST_F(SingleFault, AnAcknowledgementIsRefusedWhileTheCauseRemains) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.emergency_stop = true;
  rig.run(0.1);
  rig.request(Request::Kind::acknowledge);
  rig.tick();
  const auto refused = rig.answer(Event::Kind::request_refused);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->detail,
            Event::Detail(RequestRefusal{RefusalCode::cause_persists, FaultCode::emergency_stop}));
  rig.emergency_stop = false;
  rig.run(0.5);
  EXPECT_EQ(rig.output().state, State::faulted)
      << "a refused request is not stored: a new request is required";
}

TEST_F(SingleFault, AnAcknowledgementBeforeTheFaultDoesNotCount) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::acknowledge);
  rig.tick();
  EXPECT_TRUE(rig.answer(Event::Kind::request_refused));
  rig.emergency_stop = true;
  rig.tick();
  rig.emergency_stop = false;
  rig.run(1);
  EXPECT_EQ(rig.output().state, State::faulted);
}

TEST_F(SingleFault, AReconnectionKeepsThePressureOfTheBoard) {
  for (const bool board_vents : {true, false}) {
    settings.safety.safe_action.fill(SafeAction::vent);
    settings.safety.safe_action[static_cast<std::size_t>(Phase::holding)] = SafeAction::hold;
    settings.safety.board_vents_when_silent = board_vents;
    SimulatedRig rig(settings);
    rig.board_vents = board_vents;
    rig.stone(12);
    const PreparedSequence pick = example_sequence("pick_stone", settings);
    ASSERT_TRUE(rig.start(pick));
    ASSERT_TRUE(rig.run_until_step(2, 20));
    const double held_kpa = rig.board_kpa(0);
    rig.wire_cut = true;
    rig.run(2);
    EXPECT_NEAR(rig.board_kpa(0), board_vents ? 0 : held_kpa, 1);
    const double at_reconnection_kpa = rig.board_kpa(0);
    rig.wire_cut = false;
    rig.run(2);
    EXPECT_NEAR(rig.board_kpa(0), at_reconnection_kpa, 1) << "a reconnection moves no finger";
    EXPECT_EQ(rig.count(Event::Kind::fault_latched), 1U)
        << "readings that become too old during a bus fault must not cause a second fault";
  }
}

TEST_F(SingleFault, ALaterFaultUsesTheSafeActionOfTheFirstPhase) {
  settings.safety.safe_action.fill(SafeAction::vent);
  settings.safety.safe_action[static_cast<std::size_t>(Phase::holding)] = SafeAction::hold;
  SimulatedRig rig(settings);
  rig.stone(12);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(2, 20));
  const double held_kpa = rig.board_kpa(0);
  rig.fault[0].validity = model::Validity::out_of_range;
  rig.run(1);
  ASSERT_EQ(rig.output().first_fault.code, FaultCode::reading_out_of_range);
  rig.fault[0].validity.reset();
  rig.fault[1].validity = model::Validity::sensor_error;
  rig.run(1);
  EXPECT_EQ(rig.count(Event::Kind::fault_latched), 2U);
  EXPECT_NEAR(rig.board_kpa(0), held_kpa, 1) << "the fingers must continue to hold the part";
  rig.emergency_stop = true;
  rig.run(1);
  EXPECT_LT(rig.board_kpa(0), 1) << "the emergency stop has a separate safe action";
}

TEST_F(SingleFault, AFaultNamesTheFingerUntilTheAcknowledgement) {
  SimulatedRig rig(settings);
  ASSERT_TRUE(rig.run_until(State::idle, 1));
  rig.fault[1].validity = model::Validity::sensor_error;
  ASSERT_TRUE(rig.run_until(State::faulted, 1));
  EXPECT_EQ(rig.output().first_fault.channel, 1);
  EXPECT_EQ(rig.output().cause.code, FaultCode::sensor_error);
  EXPECT_EQ(rig.output().cause.channel, 1);
  rig.fault[1].validity.reset();
  rig.fault[0].validity = model::Validity::out_of_range;
  rig.run(0.1);
  EXPECT_EQ(rig.output().first_fault.channel, 1) << "the first fault remains latched after the second fault";
  EXPECT_EQ(rig.output().cause.code, FaultCode::reading_out_of_range)
      << "another fault now prevents the acknowledgement";
  EXPECT_EQ(rig.output().cause.channel, 0);
  rig.request(Request::Kind::acknowledge);
  rig.tick();
  const auto refused = rig.answer(Event::Kind::request_refused);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->channel, 0);
  EXPECT_EQ(refused->detail,
            Event::Detail(RequestRefusal{RefusalCode::cause_persists, FaultCode::reading_out_of_range}));
  rig.fault[0].validity.reset();
  rig.run(0.1);
  EXPECT_EQ(rig.output().cause.code, FaultCode::none);
  rig.request(Request::Kind::acknowledge);
  rig.tick();
  const auto acknowledged = rig.answer(Event::Kind::fault_acknowledged);
  ASSERT_TRUE(acknowledged);
  EXPECT_EQ(acknowledged->channel, 1);
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::none);
}

TEST_F(SingleFault, HeldPressureIsReportedOnlyWithoutARunningSequence) {
  settings.safety.safe_action.fill(SafeAction::hold);
  SimulatedRig rig(settings);
  rig.stone(12);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(2, 20));
  EXPECT_EQ(rig.output().under_pressure, 0U) << "the running sequence requested the hold";
  rig.request(Request::Kind::stop);
  ASSERT_TRUE(rig.run_until(State::idle, 5));
  EXPECT_EQ(rig.output().under_pressure, 3U);
  rig.request(Request::Kind::vent);
  rig.run(2);
  EXPECT_EQ(rig.output().under_pressure, 0U);
}

TEST_F(SingleFault, MissingCommunicationAtPowerUpIsNoFault) {
  SimulatedRig rig(settings);
  rig.wire_cut = true;
  rig.run(5);
  EXPECT_EQ(rig.output().state, State::starting);
  rig.wire_cut = false;
  EXPECT_TRUE(rig.run_until(State::idle, 0.1));
}

TEST_F(SingleFault, BriefReadingDropoutsCauseNoFault) {
  SimulatedRig rig(settings);
  rig.stone(12);
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_TRUE(rig.start(pick));
  ASSERT_TRUE(rig.run_until_step(1, 20));
  for (int i = 0; i < 30; ++i) {
    rig.fault[0].validity = model::Validity::out_of_range;
    rig.run((settings.faults.invalid_reading_cycles - 1) / settings.rate_hz);
    rig.fault[0].validity.reset();
    rig.run(2 / settings.rate_hz);
  }
  EXPECT_EQ(rig.output().first_fault.code, FaultCode::none);
  ASSERT_TRUE(rig.run_until_step(2, 20));
  EXPECT_EQ(rig.result(0), GripResult::holding);
}

// The daemon process is paused, and the last step of the sequence ends during this pause. The board may vent
// during the pause. The sequence must therefore not end before the first exchange after the pause.
TEST(FaultAfterAPause, ASequenceDoesNotEndBeforeTheFirstExchangeAfterAPause) {
  const RigSettings settings = two_finger_settings();
  const PreparedSequence brief =
      sequence_of("name: x\nsteps:\n  - move: {pressure_kpa: 10, duration_s: 1}\n", settings);
  for (const bool vented : {true, false}) {
    SimulatedRig rig(settings);
    ASSERT_TRUE(rig.start_until_step(brief, 0));
    rig.run(0.5);
    rig.pause(1);
    rig.bus_quiet = true;
    rig.tick();
    EXPECT_EQ(rig.count(Event::Kind::sequence_finished), 0U);
    rig.bus_quiet = false;
    if (vented) rig.bus_fault = FaultCode::board_watchdog_tripped;
    if (vented) rig.outputs_kpa = {0, 0};
    rig.run(2 / settings.rate_hz);
    ASSERT_EQ(rig.count(Event::Kind::sequence_finished), 1U);
    const auto finished = std::find_if(rig.events.begin(), rig.events.end(), [](const Event& event) {
      return event.kind == Event::Kind::sequence_finished;
    });
    EXPECT_EQ(std::get<SequenceEnd>(finished->detail), vented ? SequenceEnd::faulted : SequenceEnd::done);
  }
}

}  // namespace
}  // namespace softgrip::control::fault_reaction_test
