#pragma once
// Opens the end of a serial line that the emulated board uses. This end is a serial device or a
// pseudo-terminal. The daemon opens the opposite end of the line.

#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "drivers/modbus/modbus_address.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

class SerialEnd {
 public:
  /// Opens the device of `line`. If its path does not exist, creates a pseudo-terminal and a link with this
  /// path to the pseudo-terminal. The destructor removes the link. The error is one sentence.
  [[nodiscard]] static tl::expected<SerialEnd, std::string> open(const drivers::SerialLine& line);
  SerialEnd(SerialEnd&& other) noexcept;
  SerialEnd& operator=(SerialEnd&& other) noexcept;
  SerialEnd(const SerialEnd&) = delete;
  SerialEnd& operator=(const SerialEnd&) = delete;
  ~SerialEnd();

  /// Returns the times by which the server must delay its replies. The times contain the turnaround time of
  /// the module. For a pseudo-terminal, they also contain the transmission times of the bytes.
  [[nodiscard]] WireTime wire_time() const noexcept;
  /// Returns the descriptor for reading and writing, with its ownership. A second call returns an empty
  /// descriptor.
  [[nodiscard]] Descriptor take() noexcept { return std::move(end_); }
  [[nodiscard]] bool taken() const noexcept { return !end_; }

 private:
  explicit SerialEnd(drivers::SerialLine line) : line_(std::move(line)) {}
  tl::expected<void, std::string> make_pseudo();
  tl::expected<void, std::string> open_device();

  drivers::SerialLine line_;
  Descriptor end_;
  // For a pseudo-terminal: a second descriptor of the daemon's end, so that the line remains open when the
  // daemon closes its descriptor. For a device: a descriptor with a lock, so that no Modbus client of this
  // machine can use the device.
  Descriptor kept_;
  std::string link_;
  bool pseudo_ = false;
};

}  // namespace softgrip::simulation
