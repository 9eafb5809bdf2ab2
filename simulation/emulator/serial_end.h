#pragma once
// The emulated board's end of a serial line, which is a serial device or a pseudo-terminal. The daemon opens
// the other end.

#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "drivers/modbus/modbus_address.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

class SerialEnd {
 public:
  /// Opens an existing device. If the path does not exist, it creates a link with this name to a new
  /// pseudo-terminal. The destructor removes the link. The error is one sentence.
  [[nodiscard]] static tl::expected<SerialEnd, std::string> open(const drivers::SerialLine& line);
  SerialEnd(SerialEnd&& other) noexcept;
  SerialEnd& operator=(SerialEnd&& other) noexcept;
  SerialEnd(const SerialEnd&) = delete;
  SerialEnd& operator=(const SerialEnd&) = delete;
  ~SerialEnd();

  /// Returns the times that must be simulated: the turnaround, and on a pseudo-terminal also the times of the
  /// bytes.
  [[nodiscard]] WireTime wire_time() const noexcept;
  /// Returns the descriptor for reading and writing. It can be taken once.
  [[nodiscard]] Descriptor take() noexcept { return std::move(end_); }
  [[nodiscard]] bool taken() const noexcept { return !end_; }

 private:
  explicit SerialEnd(drivers::SerialLine line) : line_(std::move(line)) {}
  tl::expected<void, std::string> make_pseudo();
  tl::expected<void, std::string> open_device();

  drivers::SerialLine line_;
  Descriptor end_;
  // For a pseudo-terminal: a descriptor of the daemon's end, so that the line does not hang up when the
  // daemon closes it. For a device: a descriptor with a lock, so that other Modbus clients cannot use the
  // device.
  Descriptor kept_;
  std::string link_;
  bool pseudo_ = false;
};

}  // namespace softgrip::simulation
