#pragma once
// The board's end of a serial line: a device, or a pseudo-terminal whose other end the daemon opens.

#include <string>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "drivers/modbus/modbus_address.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

class SerialEnd {
 public:
  /// A device that exists is opened. A path that does not becomes a link to a new pseudo-terminal, and goes
  /// with this object. The error is one sentence.
  [[nodiscard]] static tl::expected<SerialEnd, std::string> open(const drivers::SerialLine& line);
  SerialEnd(SerialEnd&& other) noexcept;
  SerialEnd& operator=(SerialEnd&& other) noexcept;
  SerialEnd(const SerialEnd&) = delete;
  SerialEnd& operator=(const SerialEnd&) = delete;
  ~SerialEnd();

  /// The line's times, as far as they must be simulated: those of bytes on a pseudo-terminal, existing or
  /// new.
  [[nodiscard]] WireTime wire_time() const noexcept;
  /// What is read and written; once.
  [[nodiscard]] Descriptor take() noexcept { return std::move(end_); }
  [[nodiscard]] bool taken() const noexcept { return !end_; }

 private:
  explicit SerialEnd(drivers::SerialLine line) : line_(std::move(line)) {}
  tl::expected<void, std::string> make_pseudo();
  tl::expected<void, std::string> open_device();

  drivers::SerialLine line_;
  Descriptor end_;
  // Of a pseudo-terminal the daemon's end: without it the line would hang up when the daemon leaves. Of a
  // device what keeps others from opening it.
  Descriptor kept_;
  std::string link_;
  bool pseudo_ = false;
};

}  // namespace softgrip::simulation
