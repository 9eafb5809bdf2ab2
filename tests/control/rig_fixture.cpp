#include "tests/control/rig_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace softgrip::control {

namespace {
constexpr double noise_mm = 0.03;
constexpr double board_watchdog_s = 0.5;
constexpr double hand_mm_per_s = 200;
}  // namespace

SimulatedRig::SimulatedRig(const RigSettings& settings, std::uint64_t seed, const model::Model& truth)
    : settings_(settings), controller_(settings), readings_(settings.channels.size()), random_(seed) {
  for (std::size_t i = 0; i < settings.channels.size(); ++i) {
    plants_.push_back({model::Chain<double>(truth, {}, 1 / settings.rate_hz), 0, 0});
  }
}

void SimulatedRig::stone(std::optional<double> position_mm) {
  pulling_out_ = !position_mm;
  stone_mm_ = position_mm ? position_mm : stone_mm_;
}

void SimulatedRig::request(Request::Kind kind, const PreparedSequence* sequence) {
  request_ = {kind, next_request_++, sequence};
}

void SimulatedRig::step_plants() {
  const bool tripped = wire_cut && board_vents && silent_s_ > board_watchdog_s;
  for (std::size_t i = 0; i < plants_.size(); ++i) {
    Plant& plant = plants_[i];
    if (!wire_cut) {
      plant.board_kpa = output_.channels[i].command_kpa;
    } else if (tripped) {
      plant.board_kpa = resting_kpa(settings_.channels[i].limits);
    }
    plant.chain.step(0, plant.board_kpa);
    plant.chain.step(1 / settings_.rate_hz, plant.board_kpa);
    const double free = plant.chain.reading_mm();
    const bool meets = stone_mm_ && free > *stone_mm_ && !(stone_only_left && i > 0);
    plant.true_mm = meets ? *stone_mm_ + yields * (free - *stone_mm_) : free;
  }
  if (pulling_out_ && stone_mm_) {
    *stone_mm_ += hand_mm_per_s / settings_.rate_hz;
  }
  silent_s_ = wire_cut ? silent_s_ + 1 / settings_.rate_hz : 0;
}

void SimulatedRig::read() {
  if (bus_quiet) return;
  failures_ = wire_cut ? failures_ + 1 : 0;
  if (wire_cut) {
    return;
  }
  std::normal_distribution<double> noise(0, noise_mm);
  for (std::size_t i = 0; i < plants_.size(); ++i) {
    model::Reading& reading = readings_[i];
    const OfChannel& broken = fault[i];
    reading.displacement_mm =
        broken.frozen_mm.value_or(plants_[i].true_mm + noise(random_) + broken.offset_mm);
    reading.pressure_kpa =
        broken.no_pressure ? std::nan("") : plants_[i].chain.pressure_kpa() + broken.pressure_offset_kpa;
    reading.command_readback_kpa = plants_[i].board_kpa + broken.readback_offset_kpa;
    reading.sampled_at = now_;
    ++reading.sequence;
    reading.validity = broken.validity.value_or(model::Validity::valid);
  }
}

const TickOutput& SimulatedRig::tick() {
  if (!first_) {
    now_ += static_cast<Nanoseconds>(std::llround(1e9 / settings_.rate_hz));
    step_plants();
  }
  read();
  TickInput input;
  input.now = now_;
  input.readings = readings_;
  input.bus = {!wire_cut, wire_cut ? FaultCode::bus_timed_out : bus_fault, failures_};
  input.outputs_kpa = outputs_kpa;
  input.request = request_;
  input.emergency_stop = emergency_stop;
  input.interlock_open = interlock_open;
  input.inputs_lost = inputs_lost;
  input.overrun_cycles = overrun_cycles;
  overrun_cycles = 0;
  request_ = {};
  const TickOutput before = output_;
  around_tick(true);
  output_ = controller_.tick(input);
  around_tick(false);
  check_commands(before);
  EXPECT_EQ(output_.events.lost(), 0U);
  events.insert(events.end(), output_.events.begin(), output_.events.end());
  first_ = false;
  return output_;
}

/// Checks two rules in every tick. Each command must stay within its pressure range and its slew limits. A
/// command may move away from the rest pressure only while a sequence is allowed to move the finger.
void SimulatedRig::check_commands(const TickOutput& before) {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < settings_.channels.size(); ++i) {
    const LimitSettings& limits = settings_.channels[i].limits;
    const double command = output_.channels[i].command_kpa;
    ASSERT_TRUE(std::isfinite(command)) << "at " << time_s();
    EXPECT_GE(command, limits.pressure_min_kpa);
    EXPECT_LE(command, limits.pressure_max_kpa);
    const double rest = resting_kpa(limits);
    const double from = first_ ? rest : before.channels[i].command_kpa;
    // During a bus fault, the board may already have vented. A command may then approach the rest pressure
    // faster than its slew limit.
    const bool toward_rest = no_further(rest, command, from) == command;
    if (!inhibits(bus_fault) || !toward_rest) {
      EXPECT_LE(command - from, limits.slew_up_kpa_per_s / settings_.rate_hz + rounding) << "at " << time_s();
      EXPECT_GE(command - from, -limits.slew_down_kpa_per_s / settings_.rate_hz - rounding)
          << "at " << time_s();
    }
    if (output_.state == State::faulted || output_.state == State::starting || output_.state == State::idle ||
        output_.state == State::stopping) {
      EXPECT_NEAR(command, no_further(rest, command, from), rounding)
          << "at " << time_s() << " in " << name_of(output_.state);
    }
  }
}

void SimulatedRig::run(double seconds) {
  const auto ticks = static_cast<int>(std::lround(seconds * settings_.rate_hz));
  for (int i = 0; i < ticks; ++i) {
    tick();
  }
}

bool SimulatedRig::run_until(State state, double seconds) {
  const double end = time_s() + seconds;
  while (time_s() < end) {
    if (tick().state == state) {
      return true;
    }
  }
  return false;
}

bool SimulatedRig::run_until_step(std::uint16_t step, double seconds) {
  const double end = time_s() + seconds;
  while (time_s() < end) {
    if (tick().state == State::running && output_.channels[0].step == step) {
      return true;
    }
  }
  return false;
}

bool SimulatedRig::start(const PreparedSequence& sequence) {
  if (!run_until(State::idle, 1)) return false;
  request(Request::Kind::start, &sequence);
  return run_until(State::running, 5);
}

bool SimulatedRig::start_until_step(const PreparedSequence& sequence, std::uint16_t step, double seconds) {
  if (!run_until(State::idle, 1)) return false;
  request(Request::Kind::start, &sequence);
  return run_until_step(step, seconds);
}

std::size_t SimulatedRig::count(Event::Kind kind) const {
  return static_cast<std::size_t>(
      std::count_if(events.begin(), events.end(), [&](const Event& event) { return event.kind == kind; }));
}

std::optional<Event> SimulatedRig::answer(Event::Kind kind) const {
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    if (event->kind == kind && event->request == last_request()) {
      return *event;
    }
  }
  return std::nullopt;
}

}  // namespace softgrip::control
