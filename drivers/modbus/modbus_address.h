#pragma once
// Defines the address of a Modbus module: a host on a network, or a serial line. Several modules may share a
// serial line.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace softgrip::drivers {

/// Properties of a session that are not in the Modbus specification, but that some boards and gateways need.
struct LinkHabits {
  /// Time from opening the link to the first request [s]. Some boards ignore requests that arrive earlier.
  double settle_s = 0;
  /// Time without any byte of a response after which the request is repeated, if its deadline permits this
  /// [s]; 0: the request is never repeated.
  double repeat_after_s = 0;

  bool operator==(const LinkHabits&) const = default;
};

struct TcpAddress {
  std::string host;  ///< numeric IPv4 or IPv6 address, because the bus thread does not resolve host names
  std::uint16_t port = 502;
  LinkHabits habits{};
  bool numbered = true;        ///< true: a response contains the transaction id of its request
  bool rtu_framing = false;    ///< true: RTU frames over TCP to a serial server; RTU frames have no
                               ///< transaction id
  double silence_s = 1.75e-3;  ///< silence between two RTU frames [s], if rtu_framing is true

  bool operator==(const TcpAddress&) const = default;
};

enum class Parity : std::uint8_t { none, even, odd };

/// A serial line with Modbus RTU. Each character has 8 data bits, because RTU permits no other number.
struct SerialLine {
  std::string device;  ///< name of the device, preferably a permanent name: /dev/serial/by-id/...
  std::uint32_t baud = 9600;
  Parity parity = Parity::none;
  int stop_bits = 1;
  /// Silence before and after a frame [s]. Empty: the silence of the Modbus specification, which is 3.5
  /// characters, or 1.75 ms above 19200 baud.
  std::optional<double> silence_s;
  double turnaround_s = 0;       ///< response time of a module in addition to the silence [s]; used to
                                 ///< calculate the duration of an exchange
  double adapter_latency_s = 0;  ///< time by which the USB adapter delays a response [s]; used to calculate
                                 ///< the duration of an exchange
  bool echo = false;             ///< true: the adapter also receives all bytes that it sends
  LinkHabits habits{};

  bool operator==(const SerialLine&) const = default;
};

using ModbusAddress = std::variant<TcpAddress, SerialLine>;

}  // namespace softgrip::drivers
