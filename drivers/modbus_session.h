#pragma once
// One TCP session with a Modbus server: opening it, asking one question at a time, closing it on any doubt.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "drivers/board.h"
#include "drivers/modbus_reply.h"

namespace softgrip::drivers {

/// Everything is bounded by a point in time on CLOCK_MONOTONIC [ns], never by the time between two bytes.
/// Nothing here allocates, throws, resolves names or retries.
class ModbusSession {
 public:
  /// `host` is a numeric IPv4 or IPv6 address; with anything else open() says so and fails.
  ModbusSession(const std::string& host, std::uint16_t port, std::uint8_t unit);
  ModbusSession(const ModbusSession&) = delete;
  ModbusSession& operator=(const ModbusSession&) = delete;
  ModbusSession(ModbusSession&&) = delete;
  ModbusSession& operator=(ModbusSession&&) = delete;
  ~ModbusSession();

  /// Opens a new connection, after closing the one there was.
  [[nodiscard]] BusStatus open(Nanoseconds deadline) noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return socket_ >= 0; }

  /// Asks, and waits for the answer. On `ok` and on `exception` the session stands; on anything else it was
  /// closed.
  [[nodiscard]] BusStatus ask(const ModbusRequest& request, Nanoseconds deadline) noexcept;
  /// What the last successful ask() read: bits or registers, high byte first. Valid until the next ask().
  [[nodiscard]] std::span<const std::uint8_t> data() const noexcept { return data_; }

  /// What the last failure was.
  [[nodiscard]] const char* detail() const noexcept { return detail_.data(); }

 private:
  BusStatus wait_for(short events, Nanoseconds deadline, const char* what) noexcept;
  BusStatus send_all(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept;
  BusStatus receive(const ModbusRequest& request, Nanoseconds deadline) noexcept;
  BusStatus start_connecting() noexcept;
  BusStatus finish_connecting(Nanoseconds deadline) noexcept;
  BusStatus fail(BusStatus status, const char* what, const char* why) noexcept;

  // A sockaddr_storage, kept as bytes so that this header needs no socket headers.
  alignas(8) std::array<std::uint8_t, 128> address_{};
  std::uint32_t address_size_ = 0;
  std::uint8_t unit_;
  int socket_ = -1;
  /// Counts on across sessions: a gateway that delivers an old reply into a new session is found out too.
  std::uint16_t transaction_ = 0;
  Frame outgoing_{};
  // Larger than any reply, so that bytes behind one are seen at once.
  std::array<std::uint8_t, 512> incoming_{};
  std::span<const std::uint8_t> data_ = {};
  std::array<char, 200> detail_{};
};

}  // namespace softgrip::drivers
