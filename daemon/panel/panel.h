#pragma once
// Handles the panel with buttons and lamps: reads the digital inputs for the loop, and sets the digital
// outputs according to the state of the loop. If the process crashes, the enable output is switched off.

#include <array>
#include <atomic>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "daemon/loop/shared_state.h"
#include "daemon/loop/statistics.h"
#include "daemon/panel/trip_input.h"
#include "drivers/gpio/gpio_lines.h"
#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// Runs in a separate thread, because reading or writing a line is a system call. On a USB or I2C expander,
/// this call takes milliseconds, which is too long for a tick or an exchange. The thread waits for an edge,
/// and also reads the levels every `look_interval_s`. The loop gets two flags and the time of the last read.
///
/// If fingers are pressurised but nothing moves, a lamp blinks, 0.5 s on and 0.5 s off. In an idle rig, this
/// is the ready lamp; in a faulted rig, it is the fault lamp.
///
/// At start-up, the emergency stop counts as pressed. It counts as released when two conditions are met: the
/// loop has latched it, and the line has been released for the debounce time without interruption. Before a
/// motion, the user must also reset the fault (`acknowledge`).
class Panel {
 public:
  /// All referenced objects must exist longer than this object. Sets the inputs of `shared` to their values
  /// for lines that have not been read yet.
  Panel(std::unique_ptr<drivers::GpioLines> lines, const rig::GpioSettings& settings, const Clock& clock,
        SharedState& shared, const LoopStatistics& loop) noexcept;
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
  Panel(Panel&&) = delete;
  Panel& operator=(Panel&&) = delete;
  /// Switches the outputs off with drop().
  ~Panel();

  /// Calls step() repeatedly until stop() is called.
  void run() noexcept;
  void stop() noexcept { stopped_.store(true); }
  /// Waits for an edge until the next action is due or the look interval is over. After this wait, reads the
  /// lines and writes the outputs.
  void step() noexcept;

  /// Switches the enable output and the ready lamp off permanently. Any thread and any signal handler may
  /// call this function.
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
  SharedState& shared_;
  const LoopStatistics& loop_;
  Nanoseconds look_interval_;
  Nanoseconds stale_after_;
  std::optional<TripInput> emergency_stop_;
  std::optional<TripInput> part_;
  bool latched_ = false;  // true: the loop has latched the emergency stop, which counts as pressed at
                          // start-up
  bool lost_ = false;
  std::uint64_t ticks_ = 0;  // number of ticks of the loop at the time ticked_; the number has not changed
                             // since that time
  Nanoseconds ticked_ = 0;
  bool hung_ = false;
  std::array<std::optional<bool>, drivers::gpio_role_count> written_{};
  std::atomic<bool> stopped_{false};
  std::atomic<bool> dropped_{false};
};

/// While this object exists, the signals of a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS,
/// SIGQUIT, SIGXCPU) switch the panel's enable output off before they end the process. A program cannot
/// handle SIGKILL. Only one object may exist at a time.
class PanelGuard {
 public:
  explicit PanelGuard(Panel& panel) noexcept;
  PanelGuard(const PanelGuard&) = delete;
  PanelGuard& operator=(const PanelGuard&) = delete;
  PanelGuard(PanelGuard&&) = delete;
  PanelGuard& operator=(PanelGuard&&) = delete;
  ~PanelGuard();
};

}  // namespace softgrip::daemon
