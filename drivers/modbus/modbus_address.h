#pragma once
// The addresses of Modbus modules: a host on a network, or a serial line that several modules may share.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace softgrip::drivers {

/// Settings of a session that the Modbus specification does not contain but some boards and gateways need.
struct LinkHabits {
  /// Time from opening the link to the first request [s], because some boards ignore earlier requests.
  double settle_s = 0;
  /// Time without a byte of a response after which a request is repeated within its deadline [s]; 0: never.
  double repeat_after_s = 0;

  bool operator==(const LinkHabits&) const = default;
};

struct TcpAddress {
  std::string host;  ///< numeric IPv4 or IPv6 address, because the bus thread resolves no names
  std::uint16_t port = 502;
  LinkHabits habits{};
  bool numbered = true;        ///< responses contain the transaction id of their request
  bool rtu_framing = false;    ///< RTU frames through a serial server; they have no transaction id
  double silence_s = 1.75e-3;  ///< silence between two RTU frames

  bool operator==(const TcpAddress&) const = default;
};

enum class Parity : std::uint8_t { none, even, odd };

/// A serial line with Modbus RTU. Bytes have 8 data bits; RTU permits no other number.
struct SerialLine {
  std::string device;  ///< preferably a permanent name: /dev/serial/by-id/...
  std::uint32_t baud = 9600;
  Parity parity = Parity::none;
  int stop_bits = 1;
  /// Silence before and after a frame. If it is absent, the silence of the specification is used: 3.5
  /// characters, or 1.75 ms above 19200 baud.
  std::optional<double> silence_s;
  double turnaround_s = 0;       ///< response time of a module beyond the silence; for the budget
  double adapter_latency_s = 0;  ///< time for which the adapter delays a response; for the budget
  bool echo = false;             ///< the adapter receives all bytes that it sends
  LinkHabits habits{};

  bool operator==(const SerialLine&) const = default;
};

using ModbusAddress = std::variant<TcpAddress, SerialLine>;

}  // namespace softgrip::drivers
