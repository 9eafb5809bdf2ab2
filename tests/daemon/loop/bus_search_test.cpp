// Tests that the control loop, the bus thread and the watchdog of the board work together safely. Tries all
// sequences of events up to a maximum number of events.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "daemon/loop/bus.h"
#include "tests/daemon/scripted_board.h"

namespace softgrip::daemon::bus_search_test {
namespace {

using control::FaultCode;
using drivers::BusStatus;

constexpr Nanoseconds period = 5'000'000;
constexpr Nanoseconds watchdog = 100'000'000;

/// A board with one output. Any write clears a watchdog trip of this board, so the trip is difficult to
/// detect.
class OneOutput final : public drivers::Board {
 public:
  explicit OneOutput(const VirtualClock& clock) : clock_(clock) {}
  double output_kpa = 0;
  BusStatus next = BusStatus::ok;
  std::function<void()> on_exchange;  ///< function to call once, during the next exchange

  void look() {
    if (fed_at_ < 0 || clock_.now() - fed_at_ < watchdog || output_kpa <= 0) return;
    output_kpa = 0;
    ++trips;
  }
  int trips = 0;

  [[nodiscard]] std::size_t channels() const noexcept override { return 1; }
  [[nodiscard]] BusStatus connect(std::chrono::nanoseconds) noexcept override { return BusStatus::ok; }
  [[nodiscard]] BusStatus exchange(std::span<const double> commands_kpa, std::span<drivers::Reading>,
                                   std::chrono::nanoseconds) noexcept override {
    look();
    if (const auto meanwhile = std::exchange(on_exchange, nullptr)) meanwhile();
    const BusStatus status = next;
    next = BusStatus::ok;
    if (status == BusStatus::disconnected) return status;
    fed_at_ = clock_.now();
    // If the response is lost, the board has already executed the write, but the bus thread receives no
    // confirmation.
    if (status != BusStatus::write_refused && status != BusStatus::overwritten) output_kpa = commands_kpa[0];
    if (status == BusStatus::overwritten) output_kpa = 0;
    return status;
  }
  [[nodiscard]] std::string describe() const override { return "one output"; }
  [[nodiscard]] Budget budget() const override { return {}; }
  [[nodiscard]] bool has_watchdog() const noexcept override { return true; }
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override {
    return std::chrono::nanoseconds(watchdog);
  }

 private:
  const VirtualClock& clock_;
  Nanoseconds fed_at_ = -1;
};

/// A minimal controller. While it runs, its command rises in every tick. The controller stops when the bus
/// thread reports a fault that inhibits motion, or two failed exchanges in succession. After a stop, its
/// command does not exceed the present output. After a start, the controller runs again.
class LeastLoop {
 public:
  explicit LeastLoop(SharedState& shared) : shared_(shared) {}
  bool runs = true;
  std::uint32_t heard = 0;  ///< number of the newest inhibition by the bus thread that the controller knows

  void tick() {
    shared_.bus.fetch();
    const BusReport& report = shared_.bus.value();
    if (control::inhibits(report.health.fault) || report.health.consecutive_failures >= 2) runs = false;
    if (report.health.fault != FaultCode::none) heard = report.health.inhibit;
    if (runs) {
      command_kpa_ += 1;
    } else {
      command_kpa_ = std::min(command_kpa_, report.outputs_kpa[0]);
    }
    Commands& commands = shared_.commands.write_slot();
    commands.command_kpa[0] = command_kpa_;
    commands.safe_kpa[0] = std::max(0.0, command_kpa_ - 2);
    commands.may_rise = runs;
    commands.inhibit = report.health.inhibit;
    commands.last = false;
    shared_.commands.publish();
  }
  /// Starts the controller if the bus thread reports no fault and no failed exchange. Returns true if the
  /// controller has been started.
  bool start() {
    shared_.bus.fetch();
    const control::BusHealth& health = shared_.bus.value().health;
    if (health.fault != FaultCode::none || health.consecutive_failures > 0) return false;
    return runs = true;
  }

 private:
  SharedState& shared_;
  double command_kpa_ = 0;
};

enum class Step {
  both,
  bus_alone,
  pause,
  line_down,
  reply_lost,
  refused,
  overwritten,
  started,
  tick_meanwhile,
  count
};

/// Executes the steps in `path` one by one. Returns the property that this sequence of steps violates, or an
/// empty text if it violates no property.
std::string follow(std::span<const Step> path) {
  VirtualClock clock;
  OneOutput board(clock);
  control::RigSettings rig;
  rig.channels.resize(1);
  rig::LoopSettings loop;
  loop.max_missed_commands = 2;
  loop.exchange_deadline_s = 0.01;
  rig::ReconnectSettings reconnect;
  reconnect.first_pause = std::chrono::nanoseconds(0);
  SharedState shared(16, 16);
  BusStatistics statistics;
  Bus bus(board, rig, loop, reconnect, clock, shared, statistics);
  LeastLoop controller(shared);

  bool may_rise = true;  // true: the output may rise, because the controller has not stopped since the last
                         // start
  const auto exchange = [&]() -> std::string {
    board.look();
    const int trips = board.trips;
    const double before_kpa = board.output_kpa;
    bus.step(clock.now());
    clock.advance(period);
    if (board.output_kpa > before_kpa + 1e-9 && (!may_rise || trips > 0))
      return "an output rises although motion is inhibited";
    return {};
  };
  for (int i = 0; i < 4; ++i) {
    controller.tick();
    if (const std::string broken = exchange(); !broken.empty()) return broken;
  }
  for (const Step step : path) {
    if (step == Step::line_down) board.next = BusStatus::disconnected;
    if (step == Step::reply_lost) board.next = BusStatus::timed_out;
    if (step == Step::refused) board.next = BusStatus::write_refused;
    if (step == Step::overwritten) board.next = BusStatus::overwritten;
    if (step == Step::pause) clock.advance(watchdog);
    if (step == Step::started && controller.start()) {
      may_rise = true;
      board.trips = 0;
    }
    if (step == Step::tick_meanwhile) {
      board.on_exchange = [&] { controller.tick(); };
    } else if (step != Step::bus_alone) {
      controller.tick();
    }
    if (!controller.runs) may_rise = false;
    if (const std::string broken = exchange(); !broken.empty()) return broken;
  }
  // After the last event of the path, controller, bus and board must agree within six cycles.
  for (int i = 0; i < 6; ++i) {
    controller.tick();
    if (!controller.runs) may_rise = false;
    if (const std::string broken = exchange(); !broken.empty()) return broken;
  }
  if (controller.heard != shared.bus.value().health.inhibit)
    return "the control loop does not know the newest inhibition of motion";
  shared.bus.fetch();
  if (shared.bus.value().health.fault != FaultCode::none) return "the bus fault never ends";
  return {};
}

TEST(BusSearch, NoEventOrderRaisesAnOutputWhileInhibited) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  constexpr std::size_t depth = 4;  // number of events; lower with sanitizers, because the test is then 100
                                    // times slower
#else
  constexpr std::size_t depth = 6;
#endif
  constexpr auto kinds = static_cast<std::size_t>(Step::count);
  std::array<std::size_t, depth> digits{};
  std::array<Step, depth> path{};
  std::size_t paths = 0;
  for (bool more = true; more;) {
    for (std::size_t i = 0; i < depth; ++i) path[i] = static_cast<Step>(digits[i]);
    const std::string broken = follow(path);
    ++paths;
    std::string text;
    for (const std::size_t digit : digits) text += std::to_string(digit) + " ";
    ASSERT_EQ(broken, "") << text;
    std::size_t i = 0;
    while (i < depth && ++digits[i] == kinds) digits[i++] = 0;
    more = i < depth;
  }
  EXPECT_EQ(paths, static_cast<std::size_t>(std::pow(kinds, depth)));
}

}  // namespace
}  // namespace softgrip::daemon::bus_search_test
