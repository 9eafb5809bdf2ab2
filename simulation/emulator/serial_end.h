#pragma once
// The end of a serial line that the emulated board uses. It is a serial device or a pseudo-terminal. The
// daemon opens the other end of the line.

#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "drivers/modbus/modbus_address.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

class SerialEnd {
 public:
  /// Opens an existing device. If the path does not exist, creates a pseudo-terminal and a link with this
  /// path to it. The destructor removes the link. The error is one sentence.
  [[nodiscard]] static tl::expected<SerialEnd, std::string> open(const drivers::SerialLine& line);
  SerialEnd(SerialEnd&& other) noexcept;
  SerialEnd& operator=(SerialEnd&& other) noexcept;
  SerialEnd(const SerialEnd&) = delete;
  SerialEnd& operator=(const SerialEnd&) = delete;
  ~SerialEnd();

  /// Returns the times that the server must simulate. These are the turnaround time and, on a
  /// pseudo-terminal, also the transmission times of the bytes.
  [[nodiscard]] WireTime wire_time() const noexcept;
  /// Returns the descriptor for reading and writing. It can be returned only once.
  [[nodiscard]] Descriptor take() noexcept { return std::move(end_); }
  [[nodiscard]] bool taken() const noexcept { return !end_; }

 private:
  explicit SerialEnd(drivers::SerialLine line) : line_(std::move(line)) {}
  tl::expected<void, std::string> make_pseudo();
  tl::expected<void, std::string> open_device();

  drivers::SerialLine line_;
  Descriptor end_;
  // For a pseudo-terminal, this is a descriptor of the daemon's end, so that the line remains open when the
  // daemon closes this end. For a device, it is a descriptor with a lock, so that no other Modbus client can
  // use the device.
  Descriptor kept_;
  std::string link_;
  bool pseudo_ = false;
};

}  // namespace softgrip::simulation
