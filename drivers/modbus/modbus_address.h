#pragma once
// Where Modbus modules are: a host on a network, or a serial line that several may share.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace softgrip::drivers {

/// Settings of a session beyond the specification, for some boards and gateways.
struct LinkHabits {
  /// Time after the link is opened until the first request is sent: some boards ignore earlier ones.
  double settle_s = 0;
  /// Time after which a request without a byte of an answer is sent again, within the deadline; 0: never.
  double repeat_after_s = 0;

  bool operator==(const LinkHabits&) const = default;
};

struct TcpAddress {
  std::string host;  ///< numeric address, IPv4 or IPv6; no name is resolved in the bus thread
  std::uint16_t port = 502;
  LinkHabits habits{};
  bool numbered = true;        ///< answers carry the transaction id of their request
  bool rtu_framing = false;    ///< RTU frames, as a serial server hands them on; nothing is numbered then
  double silence_s = 1.75e-3;  ///< between two of those

  bool operator==(const TcpAddress&) const = default;
};

enum class Parity : std::uint8_t { none, even, odd };

/// A serial line with Modbus RTU. Bytes have 8 data bits: RTU knows no other.
struct SerialLine {
  std::string device;  ///< best a name that stays: /dev/serial/by-id/...
  std::uint32_t baud = 9600;
  Parity parity = Parity::none;
  int stop_bits = 1;
  /// Silence before and after a frame; absent: the specification's, 3.5 characters or, above 19200 baud,
  /// 1.75 ms.
  std::optional<double> silence_s;
  double turnaround_s = 0;       ///< what a module needs to answer beyond the silence; for the budget
  double adapter_latency_s = 0;  ///< what the adapter holds an answer back; for the budget
  bool echo = false;             ///< the adapter hears itself: everything sent comes back first
  LinkHabits habits{};

  bool operator==(const SerialLine&) const = default;
};

using ModbusAddress = std::variant<TcpAddress, SerialLine>;

}  // namespace softgrip::drivers
