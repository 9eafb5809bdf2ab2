#pragma once
// Detects fault conditions in a tick, and decides which condition has lasted long enough to be a fault. The
// supervisor latches the faults.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "control/elements/fault.h"
#include "control/tick/settings.h"
#include "control/tick/tick.h"

namespace softgrip::control {

class FaultMonitor {
 public:
  explicit FaultMonitor(const RigSettings& settings);

  /// Checks one tick. `seen` is the output of the last tick. The output that the board reports is compared
  /// with the commands in `seen` and with earlier commands. While `starting` is true, the board has not
  /// responded yet, so a missing response is no fault. Returns the most severe fault whose condition has
  /// lasted long enough. The order of the checks in the implementation is the order of severity.
  Fault observe(const TickInput& input, std::span<const ChannelOutput> seen, bool starting) noexcept;

  /// Returns the most severe fault condition of this tick. The condition is a fault, or becomes a fault if it
  /// lasts long enough. A reset of the fault during the condition would make the fault latch again.
  [[nodiscard]] const Fault& cause() const noexcept { return cause_; }
  /// Returns true if the condition for a bus fault is not met in this tick: a connection is open, and the
  /// last exchange succeeded.
  [[nodiscard]] bool bus_good() const noexcept { return bus_cycles_ == 0; }

 private:
  struct Channel {
    std::uint32_t invalid_cycles = 0;
    std::uint32_t beyond_cycles = 0;
    std::uint32_t readback_cycles = 0;
    std::uint32_t pressure_cycles = 0;
    std::uint32_t pressure_invalid_cycles = 0;
    std::uint32_t pressure_grace = 0;  ///< number of cycles in which the measured pressure may still have an
                                       ///< earlier value
    std::vector<double> sent_kpa;      ///< ring buffer of the past commands that covers the longest window
  };
  void remember(std::span<const ChannelOutput> seen) noexcept;
  void note_cause(const Fault& fault) noexcept;
  Fault bus(const BusHealth& bus, bool starting) noexcept;
  Fault channel(std::size_t index, const TickInput& input, const ChannelOutput& seen, bool starting) noexcept;
  Fault reading(Channel& channel, std::uint8_t index, const ChannelOutput& seen,
                bool starting) const noexcept;
  bool pressure_due(Channel& channel, double pressure_kpa, bool starting) const noexcept;
  /// Returns true if the pressure `kpa` is outside the range of the newest `window` commands by more than the
  /// tolerance.
  [[nodiscard]] bool off(const Channel& channel, double kpa, std::size_t window,
                         double tolerance_kpa) const noexcept;

  FaultSettings settings_;
  std::size_t readback_window_ = 0;  ///< number of past commands with which the read-back is compared,
                                     ///< including the newest command
  std::size_t pressure_window_ = 0;
  std::vector<bool> displacement_used_;
  std::vector<bool> pressure_measured_;
  std::vector<Channel> channels_;
  std::size_t ring_at_ = 0;
  std::uint32_t bus_cycles_ = 0;
  Fault cause_;
};

}  // namespace softgrip::control
