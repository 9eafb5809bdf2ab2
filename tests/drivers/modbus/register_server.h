#pragma once
// A well-behaved Modbus server on real sockets that remembers what it was asked: the board in tests of the
// board's driver. Independent of drivers/.

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "tests/drivers/modbus/scripted_server.h"

namespace softgrip::drivers::test {

class RegisterServer {
 public:
  /// One request as it came: function, address as in the first two data bytes, registers or value written.
  struct Request {
    std::uint8_t function = 0;
    std::uint16_t address = 0;
    std::uint16_t count = 0;          ///< read; 0 for pure writes
    std::uint16_t write_address = 0;  ///< of 5, 6, 16, 23
    std::vector<std::uint16_t> written;

    bool operator==(const Request&) const = default;
  };

  RegisterServer();

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  [[nodiscard]] std::size_t sessions() const { return server_.sessions(); }

  /// Registers by table; what was never set reads as 0.
  void set_holding(std::uint16_t address, std::uint16_t value);
  void set_input(std::uint16_t address, std::uint16_t value);
  void set_coil(std::uint16_t address, std::uint16_t value);
  [[nodiscard]] std::uint16_t holding(std::uint16_t address);
  [[nodiscard]] std::uint16_t coil(std::uint16_t address);
  /// Reads of input registers give the holding registers, as many boards do.
  void mirror_inputs(bool mirrored);
  /// Requests with this function are answered with that exception from now on; nothing: as usual.
  void refuse(std::optional<std::uint8_t> function, std::uint8_t code = 2);
  /// Writes are confirmed and forgotten.
  void ignore_writes(bool ignored);
  /// Called with every request before it is carried out, under the lock: may change registers.
  void on_request(std::function<void(RegisterServer&, const Request&)> hook);
  /// Answers late by so much.
  void delay(std::chrono::milliseconds duration);
  /// All requests since the last call.
  [[nodiscard]] std::vector<Request> take_requests();

  // For hooks, which already hold the lock.
  std::map<std::uint16_t, std::uint16_t> holding_;
  std::map<std::uint16_t, std::uint16_t> input_;
  std::map<std::uint16_t, std::uint16_t> coils_;

 private:
  Bytes answer(const Bytes& frame);
  Bytes carry_out(const Bytes& frame, const Request& request);
  Bytes read_registers(const std::map<std::uint16_t, std::uint16_t>& table, const Request& request);
  Bytes read_bits(const Request& request);

  std::recursive_mutex mutex_;
  std::vector<Request> requests_;
  std::optional<std::uint8_t> refused_;
  std::uint8_t refusal_ = 2;
  bool writes_ignored_ = false;
  bool mirrored_ = false;
  std::chrono::milliseconds delay_{0};
  std::function<void(RegisterServer&, const Request&)> hook_;
  ScriptedServer server_;  // last: its thread uses everything above
};

}  // namespace softgrip::drivers::test
