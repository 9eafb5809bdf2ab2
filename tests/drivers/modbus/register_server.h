#pragma once
// A correct Modbus server on real sockets that records its requests. It acts as the board in tests of the
// driver and does not use any code of drivers/.

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "tests/drivers/modbus/scripted_server.h"

namespace softgrip::drivers::test {

class RegisterServer {
 public:
  /// One received request: function code, address from the first two data bytes, and the registers or value
  /// written.
  struct Request {
    std::uint8_t function = 0;
    std::uint16_t address = 0;
    std::uint16_t count = 0;          ///< number of registers to read; 0 for pure writes
    std::uint16_t write_address = 0;  ///< for function codes 5, 6, 16 and 23
    std::vector<std::uint16_t> written;

    bool operator==(const Request&) const = default;
  };

  RegisterServer();

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  [[nodiscard]] std::size_t sessions() const { return server_.sessions(); }

  /// Sets a register of a table; a register that was never set reads as 0.
  void set_holding(std::uint16_t address, std::uint16_t value);
  void set_input(std::uint16_t address, std::uint16_t value);
  void set_coil(std::uint16_t address, std::uint16_t value);
  [[nodiscard]] std::uint16_t holding(std::uint16_t address);
  [[nodiscard]] std::uint16_t coil(std::uint16_t address);
  /// If true, reads of input registers return the holding registers, as on many boards.
  void mirror_inputs(bool mirrored);
  /// Answers requests with this function code with the exception `code`; nullopt: normal responses.
  void refuse(std::optional<std::uint8_t> function, std::uint8_t code = 2);
  /// If true, writes are confirmed but have no effect.
  void ignore_writes(bool ignored);
  /// Sets a hook that is called under the lock before each request is executed. The hook may change
  /// registers.
  void on_request(std::function<void(RegisterServer&, const Request&)> hook);
  /// Delays every response by `duration`.
  void delay(std::chrono::milliseconds duration);
  /// Returns all requests since the last call.
  [[nodiscard]] std::vector<Request> take_requests();

  // The registers are public for the hooks, which already hold the lock.
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
  ScriptedServer server_;  // declared last, because its thread uses all other members
};

}  // namespace softgrip::drivers::test
