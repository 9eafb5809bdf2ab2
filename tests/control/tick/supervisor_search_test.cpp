// Searches all reachable states of the supervisor. In each state, applies all combinations of the inputs that
// the supervisor can receive in one tick.

#include "control/tick/supervisor.h"

#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "tests/control/settings_fixture.h"

namespace softgrip::control::supervisor_search_test {
namespace {

using Kind = Request::Kind;

/// The inputs of the supervisor for one tick.
struct Tick {
  Kind request = Kind::none;
  FaultCode fault = FaultCode::none;
  bool cause_present = false;
  bool bus_good = true;
  bool all_ready = true;
  bool all_at_rest = false;
  bool interlock_open = false;
  Phase phase = Phase::idle;
  Rest rest = Rest::pending;
  bool sequence_ends = false;  // true: the sequence ends after this tick, provided that a sequence runs
  std::uint32_t of_start = 0;  // number of the start request that a stop request cancels
};

constexpr std::uint32_t own_start = 2;
constexpr std::uint32_t another_start = 9;

std::vector<Tick> all_ticks() {
  std::vector<Tick> ticks;
  for (const Kind request :
       {Kind::none, Kind::start, Kind::check, Kind::stop, Kind::vent, Kind::acknowledge, Kind::release}) {
    for (const FaultCode fault : {FaultCode::none, FaultCode::bus_down, FaultCode::board_watchdog_tripped,
                                  FaultCode::sensor_error, FaultCode::emergency_stop}) {
      for (const Phase phase : {Phase::idle, Phase::closing, Phase::holding, Phase::releasing}) {
        for (const Rest rest : {Rest::pending, Rest::at_rest, Rest::timed_out}) {
          for (unsigned bits = 0; bits < 64; ++bits) {
            const bool cause = (bits & 1U) != 0 || fault != FaultCode::none;
            ticks.push_back({request, fault, cause, (bits & 2U) == 0, (bits & 4U) == 0, (bits & 8U) != 0,
                             (bits & 16U) != 0, phase, rest, (bits & 32U) != 0});
            if (request != Kind::stop) continue;
            for (const std::uint32_t of_start : {own_start, another_start}) {
              ticks.push_back(ticks.back());
              ticks.back().of_start = of_start;
            }
          }
        }
      }
    }
  }
  return ticks;
}

/// All members of the object are plain values, so the test identifies a state by the bytes of the object.
static_assert(std::is_trivially_copyable_v<Supervisor>);
using Bytes = std::array<char, sizeof(Supervisor)>;
Bytes bytes_of(const Supervisor& supervisor) {
  Bytes bytes{};
  std::memcpy(bytes.data(), &supervisor, sizeof supervisor);
  return bytes;
}
struct HashOfBytes {
  std::size_t operator()(const Bytes& bytes) const {
    return std::hash<std::string_view>{}({bytes.data(), bytes.size()});
  }
};

class SupervisorSearch : public testing::Test {
 protected:
  SupervisorSearch() { sequence_.interlock = Interlock::always; }

  /// Runs one tick. Returns the description of the rule that the supervisor has violated, or nullptr if it
  /// has violated no rule.
  const char* step(Supervisor& supervisor, const Tick& tick) {
    const State before = supervisor.state();
    TickInput input;
    // In this test, a stop never arrives before the start that it refers to. Another test covers a stop that
    // overtakes its start.
    const bool names_one = tick.request == Kind::start || tick.request == Kind::check;
    const std::uint32_t id = tick.of_start != 0 ? own_start + 1 : names_one ? own_start : 1;
    input.request = {tick.request, id, names_one ? &sequence_ : nullptr, tick.of_start};
    input.interlock_open = tick.interlock_open;
    input.emergency_stop = tick.fault == FaultCode::emergency_stop;
    SupervisorInputs inputs;
    inputs.fault = {tick.fault, whole_rig, 0};
    if (tick.cause_present) inputs.cause.code = FaultCode::sensor_error;
    inputs.bus_good = tick.bus_good;
    inputs.ready = tick.all_ready ? all : 1;
    inputs.at_rest = tick.all_at_rest ? all : 0;
    inputs.phase = tick.phase;
    inputs.rest = tick.rest;
    EventList events;
    const SupervisorOutputs outputs = supervisor.tick(input, inputs, events);
    const char* broken = judge(before, supervisor, tick, outputs, events);
    if (tick.sequence_ends && supervisor.state() == State::running) {
      supervisor.sequence_ended(SequenceEnd::done, OnFail::release, tick.phase, events);
      if (may_rise(supervisor.state())) broken = "a sequence that has ended continues";
    }
    return broken;
  }

  static const char* judge(State before, const Supervisor& supervisor, const Tick& tick,
                           const SupervisorOutputs& outputs, const EventList& events) {
    const State after = supervisor.state();
    std::size_t answers = 0;
    bool started = false;
    bool acknowledged = false;
    for (const Event& event : events) {
      answers += event.request != 0 && event.kind != Event::Kind::sequence_finished ? 1 : 0;
      started = started || event.kind == Event::Kind::sequence_started;
      acknowledged = acknowledged || event.kind == Event::Kind::fault_acknowledged;
    }
    const bool stops = tick.request == Kind::stop && tick.of_start != another_start;
    const bool halts = tick.request == Kind::vent || (stops && may_rise(before));
    const bool undisturbed = tick.fault == FaultCode::none && !tick.interlock_open;
    if (tick.of_start == another_start && undisturbed && before == State::running && after != before)
      return "a stop request that names another start ends the running sequence";
    if (tick.fault != FaultCode::none && after != State::faulted)
      return "a fault whose condition is fulfilled is not latched";
    if (halts && may_rise(after)) return "motion continues after a stop or a vent";
    if (tick.request == Kind::vent && supervisor.venting() != all && after != State::idle)
      return "a vent request is refused";
    if (outputs.release && after == State::running && supervisor.sequence() == nullptr)
      return "the supervisor requests the release step although no sequence runs";
    if (tick.request == Kind::release && before == State::resynchronising && may_rise(after))
      return "motion continues after a release";
    if (after == State::resynchronising && before != after && !started)
      return "a motion begins without a request";
    if (after == State::running && before != after && before != State::resynchronising)
      return "a motion begins without a check of the rest position";
    if (outputs.begin != nullptr && after != State::running)
      return "a sequence runs in a state in which no sequence may run";
    if (started && (tick.interlock_open || !tick.bus_good || !tick.all_ready) && tick.request == Kind::start)
      return "a start is accepted that must be refused";
    if (before == State::faulted && after != State::faulted && !acknowledged)
      return "a fault disappears without an acknowledgement";
    if (acknowledged && tick.cause_present) return "a fault is acknowledged while its cause is present";
    if (may_rise(after) && supervisor.sequence() == nullptr)
      return "the state permits motion, but no sequence runs";
    if (!may_rise(after) && supervisor.sequence() != nullptr)
      return "a sequence runs, but the state permits no motion";
    if (tick.request != Kind::none && answers == 0 && !outputs.acknowledged_by)
      return "a request gets no response";
    if (after == State::faulted && (tick.fault == FaultCode::board_watchdog_tripped) &&
        supervisor.venting() != all)
      return "the controller holds an output that the board has already vented";
    if (after == State::faulted && supervisor.venting_on_leaving(tick.phase) != supervisor.venting())
      return "the shutdown changes the safe action of a fault";
    return nullptr;
  }

  static constexpr std::uint32_t all = 3;
  RigSettings settings_ = two_finger_settings();
  PreparedSequence sequence_ = example_sequence("pick_stone", settings_);
};

TEST_F(SupervisorSearch, NoReachableStateViolatesARule) {
  const std::vector<Tick> ticks = all_ticks();
  std::unordered_set<Bytes, HashOfBytes> seen;
  std::deque<Supervisor> open{Supervisor(settings_)};
  seen.insert(bytes_of(open.front()));
  std::size_t steps = 0;
  while (!open.empty()) {
    const Supervisor from = open.front();
    open.pop_front();
    for (const Tick& tick : ticks) {
      Supervisor to = from;
      const char* const broken = step(to, tick);
      ++steps;
      // A macro of GoogleTest in each step would take most of the time of the search.
      if (broken != nullptr)
        FAIL() << broken << " from " << name_of(from.state()) << " by request "
               << static_cast<int>(tick.request) << ", fault " << static_cast<int>(tick.fault) << ", phase "
               << static_cast<int>(tick.phase) << ", rest " << static_cast<int>(tick.rest) << " to "
               << name_of(to.state());
      if (seen.insert(bytes_of(to)).second) open.push_back(to);
    }
    ASSERT_LT(seen.size(), 100'000U) << "the number of different states is too large for a complete search";
  }
  std::printf("%zu states, %zu steps\n", seen.size(), steps);
  EXPECT_GT(seen.size(), 20U);
}

}  // namespace
}  // namespace softgrip::control::supervisor_search_test
