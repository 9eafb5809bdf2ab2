#pragma once
// A wire with Modbus modules at its other end: one question at a time, and an end at any doubt.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "drivers/board/board.h"
#include "drivers/modbus/modbus_address.h"
#include "drivers/modbus/modbus_request.h"

namespace softgrip::drivers {

/// Everything is bounded by a point in time on CLOCK_MONOTONIC [ns], never by the time between two bytes.
/// Nothing but cost() and describe() allocates; nothing throws, resolves names or retries.
class ModbusLink {
 public:
  ModbusLink() = default;
  ModbusLink(const ModbusLink&) = delete;
  ModbusLink& operator=(const ModbusLink&) = delete;
  ModbusLink(ModbusLink&&) = delete;
  ModbusLink& operator=(ModbusLink&&) = delete;
  virtual ~ModbusLink() = default;

  /// Opens the link, after closing the one there was.
  [[nodiscard]] virtual BusStatus open(Nanoseconds deadline) noexcept = 0;
  virtual void close() noexcept = 0;
  [[nodiscard]] virtual bool is_open() const noexcept = 0;

  /// Asks, and waits for the answer. On `ok` and on `exception` the link stands; on anything else it was
  /// closed, so that a late or duplicated reply cannot be taken for the answer to a later question.
  [[nodiscard]] virtual BusStatus ask(std::uint8_t unit, const ModbusRequest& request,
                                      Nanoseconds deadline) noexcept = 0;
  /// What the last successful ask() read: bits or registers, high byte first. Valid until the next ask().
  [[nodiscard]] virtual std::span<const std::uint8_t> data() const noexcept = 0;
  /// What the last failure was.
  [[nodiscard]] virtual const char* detail() const noexcept = 0;

  /// Measurements for cost(): none from now on; the last ask() was one.
  virtual void forget_measurements() noexcept = 0;
  virtual void keep_measurement() noexcept = 0;

  /// What these transactions take, one after the other, and how it adds up. `plan` says in words what they
  /// are.
  [[nodiscard]] virtual Board::Budget cost(std::span<const TransactionSize> transactions,
                                           const std::string& plan) const = 0;
  /// "127.0.0.1:502", "/dev/ttyUSB0, 115200 8N1"
  [[nodiscard]] virtual std::string describe() const = 0;
};

[[nodiscard]] std::unique_ptr<ModbusLink> make_link(const ModbusAddress& address);

}  // namespace softgrip::drivers
