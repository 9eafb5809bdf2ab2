#pragma once
// A board that consists of converters of this computer, through the kernel's industrial I/O attributes in
// sysfs. See Documentation/ABI/testing/sysfs-bus-iio of the kernel.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/board/board.h"
#include "drivers/board/channel_wiring.h"

namespace softgrip::drivers {

/// One channel of a converter: "voltage0", "current2", or a differential one, "voltage0-voltage1".
struct IioTerminal {
  std::string device;  ///< a word that matches one of converters_in()
  std::string channel;
  long raw_max = 0;  ///< for outputs: the largest raw number of the converter; the smallest is 0
};

/// An output that changes in each exchange. An external circuit switches off the supply of the valves if the
/// output has not changed for `timeout_s`.
struct IioHeartbeat {
  IioTerminal terminal;
  long first = 0;  ///< raw numbers
  long second = 0;
  double timeout_s = 0;  ///< time-out of the circuit [s]
};

/// Largest number of channels, equal to that of the control.
inline constexpr std::size_t most_channels = 16;

struct IioSettings {
  std::string root = "/sys/bus/iio/devices";
  std::vector<IioTerminal> inputs;   ///< input i of the wiring
  std::vector<IioTerminal> outputs;  ///< output i of the wiring
  std::optional<IioHeartbeat> heartbeat;
  std::vector<ChannelWiring> wiring;
};

/// Returns the unit of a channel by its name; nothing if it is not a voltage, current or pressure.
[[nodiscard]] std::optional<ElectricalUnit> unit_of_channel(std::string_view channel) noexcept;
/// Returns the terminals of such a board with their units. Only the converters know their ranges.
[[nodiscard]] ModuleTerminals terminals_of(const IioSettings& settings);

/// One exchange writes the raw numbers of all outputs, then reads those of all inputs. Each needs one system
/// call on a descriptor that connect() opened. Scales and offsets are read once. V = (raw + offset) * scale /
/// 1000; mA and kPa = (raw + offset) * scale. An input without a raw number has a processed one in mV, mA or
/// kPa.
///
/// A conversion happens inside a system call and cannot be interrupted, so the deadline is checked after each
/// one. The only watchdog is the circuit of a heartbeat: without it, the outputs keep their last value when
/// the daemon stops.
///
/// If the `powerdown` attribute of an output is 1, the first exchange writes the number and then switches the
/// output on. In the opposite order, the output would have an old value for a moment. connect() fails if
/// switching on is not permitted or had no effect before.
///
/// connect() refuses a word that matches no converter or several, and two terminals that are the same. In
/// later sessions a word must lead to the same converter, unless it is a label or a serial number. Otherwise
/// another converter of that name could receive the commands.
class IioBoard final : public Board {
 public:
  explicit IioBoard(const IioSettings& settings);
  ~IioBoard() override;

  [[nodiscard]] std::size_t channels() const noexcept override;
  [[nodiscard]] BusStatus connect(std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                   std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] const char* detail() const noexcept override;
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] Budget budget() const override;
  [[nodiscard]] bool has_watchdog() const noexcept override;
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::drivers
