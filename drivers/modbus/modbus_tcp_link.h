#pragma once
// One TCP session with a Modbus server: opening it, asking one question at a time, closing it on any doubt.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "drivers/board/round_trip.h"
#include "drivers/modbus/mbap.h"
#include "drivers/modbus/modbus_link.h"

namespace softgrip::drivers {

class ModbusTcpLink final : public ModbusLink {
 public:
  /// With a host that is no numeric address open() says so and fails.
  explicit ModbusTcpLink(const TcpAddress& address);
  ~ModbusTcpLink() override;

  [[nodiscard]] BusStatus open(Nanoseconds deadline) noexcept override;
  void close() noexcept override;
  [[nodiscard]] bool is_open() const noexcept override { return socket_ >= 0; }
  [[nodiscard]] BusStatus ask(std::uint8_t unit, const ModbusRequest& request,
                              Nanoseconds deadline) noexcept override;
  [[nodiscard]] std::span<const std::uint8_t> data() const noexcept override { return data_; }
  [[nodiscard]] const char* detail() const noexcept override { return detail_.data(); }
  void forget_measurements() noexcept override { round_trips_.reset(); }
  void keep_measurement() noexcept override { round_trips_.add(last_round_trip_); }
  [[nodiscard]] Board::Budget cost(std::span<const TransactionSize> transactions,
                                   const std::string& plan) const override;
  [[nodiscard]] std::string describe() const override;

 private:
  BusStatus wait_until_ready(short events, Nanoseconds deadline, const char* what) noexcept;
  BusStatus send_all(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept;
  BusStatus receive(std::uint8_t unit, const ModbusRequest& request, Nanoseconds deadline) noexcept;
  BusStatus start_connecting() noexcept;
  BusStatus finish_connecting(Nanoseconds deadline) noexcept;
  BusStatus fail(BusStatus status, const char* what, const char* why) noexcept;

  TcpAddress settings_;
  // A sockaddr_storage, kept as bytes so that this header needs no socket headers.
  alignas(8) std::array<std::uint8_t, 128> address_{};
  std::uint32_t address_size_ = 0;
  int socket_ = -1;
  /// Counts on across sessions: a gateway that delivers an old reply into a new session is found out too.
  std::uint16_t transaction_ = 0;
  Frame outgoing_{};
  // Larger than any reply, so that bytes behind one are seen at once.
  std::array<std::uint8_t, 512> incoming_{};
  std::span<const std::uint8_t> data_ = {};
  RoundTrip round_trips_;
  Nanoseconds last_round_trip_ = 0;
  std::array<char, 200> detail_{};
};

}  // namespace softgrip::drivers
