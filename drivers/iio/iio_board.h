#pragma once
// Implements a board that consists of A/D and D/A converters of this computer. The class uses the industrial
// I/O attributes in sysfs, which the Linux kernel documents in Documentation/ABI/testing/sysfs-bus-iio.

#include <cstddef>
#include <memory>
#include <string>

#include "drivers/board/board.h"
#include "drivers/iio/iio_settings.h"

namespace softgrip::drivers {

/// One exchange writes the raw numbers of all wired outputs, and then reads the raw numbers of all wired
/// inputs. Each read or write of a number is one system call on a descriptor that connect() opened. connect()
/// also reads scales and offsets: V = (raw + offset) * scale / 1000; mA and kPa = (raw + offset) * scale. If
/// an input has no raw number, its processed number in mV, mA or kPa is used.
///
/// A conversion happens inside a system call and cannot be interrupted. Therefore, the deadline is checked
/// after the reads of each channel. The only possible watchdog is an external circuit that monitors a
/// heartbeat output. Without this circuit, the outputs keep their last value when the daemon stops.
///
/// A terminal that cannot be used must not prevent the writes to the other outputs, because these outputs may
/// be under pressure. Therefore, connect() succeeds if at least one output of a channel can be written. If a
/// terminal cannot be used, the first exchange writes the commands to all other outputs and returns
/// `disconnected`, and detail() contains the reason. The heartbeat does not change in this exchange. If the
/// write to an output fails, the exchange still writes the other outputs.
///
/// If the `powerdown` attribute of an output is 1, the first exchange writes the number and then switches the
/// output on. In the opposite order, the output would have an old value for a short time. The terminal cannot
/// be used if the process may not switch the output on, or if an earlier attempt to switch it on had no
/// effect. While a terminal cannot be used, no output is switched on.
///
/// A terminal also cannot be used if the word for its converter does not match exactly one converter, or if
/// it is the same channel as another terminal. In later sessions, each word must match the converter of the
/// first complete session. Otherwise, another converter with the same name could receive the commands. A word
/// that is a label or a serial number is not checked in later sessions.
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
