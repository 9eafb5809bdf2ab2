#pragma once
// A correct Modbus server on real sockets that records all requests. It simulates the board in tests of the
// driver. It uses no code of drivers/.

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "tests/drivers/modbus/scripted_server.h"

namespace softgrip::drivers::test {

class RegisterServer {
 public:
  /// A request that the server has received.
  struct Request {
    std::uint8_t function = 0;
    std::uint16_t address = 0;        ///< first address to read; without a read, first address to write
    std::uint16_t count = 0;          ///< number of registers to read; 0: the request only writes
    std::uint16_t write_address = 0;  ///< first address to write, with function codes 5, 6, 16 and 23
    std::vector<std::uint16_t> written;

    bool operator==(const Request&) const = default;
  };

  RegisterServer();

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  [[nodiscard]] std::size_t sessions() const { return server_.sessions(); }

  /// Sets a holding register. A register that was never set contains 0.
  void set_holding(std::uint16_t address, std::uint16_t value);
  void set_input(std::uint16_t address, std::uint16_t value);
  void set_coil(std::uint16_t address, std::uint16_t value);
  [[nodiscard]] std::uint16_t holding(std::uint16_t address);
  [[nodiscard]] std::uint16_t coil(std::uint16_t address);
  /// If `mirrored` is true, a read of input registers returns the holding registers. Many boards behave in
  /// this way.
  void mirror_inputs(bool mirrored);
  /// Makes the server respond with the exception `code` to requests that have the function code `function`.
  /// With nullopt, all responses are normal.
  void refuse(std::optional<std::uint8_t> function, std::uint8_t code = 2);
  /// If `ignored` is true, the server confirms writes but does not execute them.
  void ignore_writes(bool ignored);
  /// Sets a function that the server calls before it executes each request. The function may change
  /// registers, because the server holds the lock during the call.
  void on_request(std::function<void(RegisterServer&, const Request&)> hook);
  /// Delays every response of the server by `duration`.
  void delay(std::chrono::milliseconds duration);
  /// Returns all requests that the server has received since the last call.
  [[nodiscard]] std::vector<Request> take_requests();

  // The register tables. They are public, so that the function of on_request() can change them while the
  // server holds the lock.
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
  ScriptedServer server_;  // declared last, because its thread uses all other members and must end before
                           // their destruction
};

}  // namespace softgrip::drivers::test
