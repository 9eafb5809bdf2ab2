#pragma once
// A board made of converters on this computer, through the kernel's industrial I/O attributes in sysfs.
// Documentation/ABI/testing/sysfs-bus-iio of the kernel.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/board/board.h"
#include "drivers/board/channel_wiring.h"

namespace softgrip::drivers {

/// One channel of a converter. "voltage0", "current2", differential ones "voltage0-voltage1".
struct IioTerminal {
  std::string device;  ///< a word that fits one of converters_in()
  std::string channel;
  long raw_max = 0;  ///< outputs: the largest raw number that the converter takes; the smallest is 0
};

/// An output that changes with every exchange. A circuit behind it takes the valves' supply away if it has
/// not changed for a time.
struct IioHeartbeat {
  IioTerminal terminal;
  long first = 0;  ///< raw numbers
  long second = 0;
  double timeout_s = 0;  ///< of the circuit
};

/// As many channels as control has.
inline constexpr std::size_t most_channels = 16;

struct IioSettings {
  std::string root = "/sys/bus/iio/devices";
  std::vector<IioTerminal> inputs;   ///< input i of the wiring
  std::vector<IioTerminal> outputs;  ///< output i of the wiring
  std::optional<IioHeartbeat> heartbeat;
  std::vector<ChannelWiring> wiring;
};

/// The unit that a channel's name means; nothing for a channel that is no voltage, current or pressure.
[[nodiscard]] std::optional<ElectricalUnit> unit_of_channel(std::string_view channel) noexcept;
/// What such a board offers: unit by unit, ranges only the converters know.
[[nodiscard]] ModuleTerminals terminals_of(const IioSettings& settings);

/// One exchange writes the raw numbers of all outputs, then reads those of all inputs, each by one system
/// call on a descriptor that connect() opened; scales and offsets are read once. V = (raw + offset) * scale /
/// 1000, mA and kPa = (raw + offset) * scale, and the way back. An input without a raw number gives its
/// processed one: mV, mA or kPa.
///
/// A conversion happens inside the system call and cannot be cut short: the deadline is looked at after each.
/// There is no watchdog but a heartbeat's circuit: the outputs keep their last value when nobody writes.
///
/// An output whose `powerdown` is 1 is switched on by the first exchange, after its number was written: it
/// would show an old one. connect() refuses it if that is not permitted, or did not help before.
///
/// connect() refuses a word that fits no converter or several, and two terminals that are one. After a
/// session a word must mean the same converter again, unless it is a label or a serial number: another one of
/// that name would get the commands of the one that is gone.
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
