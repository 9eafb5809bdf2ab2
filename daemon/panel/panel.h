#pragma once
// Buttons and lamps: reads the digital inputs for the loop and drives the digital outputs by what the loop
// does.

#include <array>
#include <atomic>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "daemon/loop/statistics.h"
#include "daemon/loop/wires.h"
#include "daemon/panel/trip_input.h"
#include "drivers/gpio/gpio_lines.h"
#include "rig/gpio_settings.h"

namespace softgrip::daemon {

/// A thread of its own, because reading or writing a line is a system call, on a USB or I2C expander one of
/// milliseconds: neither belongs into a tick or an exchange. It sleeps until an edge comes, and looks at the
/// levels every `look_interval_s` all the same. The loop sees two flags and the time of the last look.
///
/// While pressure stays on although nothing moves, the lamp that is on blinks, half a second on and half a
/// second off: the ready lamp of an idle rig, the fault lamp of a faulted one.
///
/// The emergency stop counts as pressed from the start. It counts as released when the loop has latched it
/// and the line has been steadily released; motion then still needs an acknowledgement.
class Panel {
 public:
  /// All references outlive it. Sets the inputs of `wires` to what they are before anything is known.
  Panel(std::unique_ptr<drivers::GpioLines> lines, const rig::GpioSettings& settings, const Clock& clock,
        Wires& wires, const LoopStatistics& loop) noexcept;
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
  Panel(Panel&&) = delete;
  Panel& operator=(Panel&&) = delete;
  /// drop()
  ~Panel();

  /// Steps until stop().
  void run() noexcept;
  void stop() noexcept { stopped_.store(true); }
  /// Waits for an edge, at most until something is due or the look interval is over; then acts.
  void step() noexcept;

  /// Enable output and ready lamp off, for good. Any thread; safe in a signal handler.
  void drop() noexcept;

 private:
  void read_inputs() noexcept;
  void publish(Nanoseconds now) noexcept;
  void lose(Nanoseconds now) noexcept;
  void drive(Nanoseconds now) noexcept;
  void tell(PanelEvent::Kind kind, Nanoseconds now) noexcept;
  void write(drivers::GpioRole role, bool active) noexcept;
  [[nodiscard]] bool loop_hangs(Nanoseconds now) noexcept;
  [[nodiscard]] bool enable_wanted(control::State state, bool hangs) const noexcept;
  [[nodiscard]] TripInput* input(drivers::GpioRole role) noexcept;
  [[nodiscard]] Nanoseconds pause(Nanoseconds now) const noexcept;

  std::unique_ptr<drivers::GpioLines> lines_;
  const rig::GpioSettings& settings_;
  const Clock& clock_;
  Wires& wires_;
  const LoopStatistics& loop_;
  Nanoseconds look_interval_;
  Nanoseconds stale_after_;
  std::optional<TripInput> emergency_stop_;
  std::optional<TripInput> part_;
  bool latched_ = false;  // the loop has latched the emergency stop of the start
  bool lost_ = false;
  std::uint64_t ticks_ = 0;  // of the loop, and since when they stand still
  Nanoseconds ticked_ = 0;
  bool hung_ = false;
  std::array<std::optional<bool>, drivers::gpio_role_count> written_{};
  std::atomic<bool> stopped_{false};
  std::atomic<bool> dropped_{false};
};

}  // namespace softgrip::daemon
