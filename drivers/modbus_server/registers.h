#pragma once
// Implements the registers of a Modbus server, and the responses to requests without framing. The responses
// follow MODBUS Application Protocol Specification V1.1b3, sections 6.3, 6.4, 6.6, 6.12, 6.17 and 7.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "drivers/modbus_server/requests.h"

namespace softgrip::modbus {

/// Returns the reply that reports the exception `code` for a request with the function code `function`.
[[nodiscard]] Bytes exception_reply(std::uint8_t function, std::uint8_t code);

/// The registers of a server (holding and input registers), its coils and its discrete inputs. A request for
/// an undefined address gets an exception and not the value 0, so that a client with a wrong address detects
/// its error. As in the ADAM-6000, the read functions of both tables can read an address that only one table
/// contains.
class Registers {
 public:
  enum class Access : std::uint8_t { read_only, read_write };

  void define_holding(std::uint16_t address, Access access, std::uint16_t value = 0);
  void define_input(std::uint16_t address, std::uint16_t value = 0);
  void define_coil(std::uint16_t address, bool value = false);
  void define_discrete_input(std::uint16_t address, bool value = false);
  /// Permits a function code. A request with a function code that is not permitted causes the exception
  /// illegal_function.
  void allow(std::uint8_t function) { functions_.insert(function); }

  [[nodiscard]] std::uint16_t holding(std::uint16_t address) const { return holding_.at(address).value; }
  [[nodiscard]] std::uint16_t input(std::uint16_t address) const { return input_.at(address); }
  [[nodiscard]] bool has_holding(std::uint16_t address) const { return holding_.contains(address); }
  [[nodiscard]] bool has_input(std::uint16_t address) const { return input_.contains(address); }
  [[nodiscard]] bool coil(std::uint16_t address) const { return coils_.at(address); }
  void set_holding(std::uint16_t address, std::uint16_t value) { holding_.at(address).value = value; }
  void set_input(std::uint16_t address, std::uint16_t value) { input_.at(address) = value; }
  void set_coil(std::uint16_t address, bool value) { coils_.at(address) = value; }
  void set_discrete_input(std::uint16_t address, bool value) { discrete_inputs_.at(address) = value; }

  struct Answer {
    Bytes pdu;
    bool wrote = false;  ///< true: the request wrote registers or a coil, with new or with unchanged values
  };
  /// Returns the response to one request PDU (function code and data, at least one byte). A request is
  /// executed either completely or not at all.
  Answer answer(std::span<const std::uint8_t> pdu);

 private:
  struct Holding {
    std::uint16_t value = 0;
    Access access = Access::read_only;
  };

  Answer read_registers(std::span<const std::uint8_t> pdu, bool holding) const;
  static Answer read_bits(std::span<const std::uint8_t> pdu, const std::map<std::uint16_t, bool>& bits);
  Answer write_coil(std::span<const std::uint8_t> pdu);
  Answer write_single(std::span<const std::uint8_t> pdu);
  Answer write_multiple(std::span<const std::uint8_t> pdu);
  Answer read_write(std::span<const std::uint8_t> pdu);
  [[nodiscard]] std::optional<std::uint16_t> value_of(std::size_t address, bool holding) const;
  [[nodiscard]] bool writable(std::uint16_t first, std::size_t count) const;
  /// Appends the values of registers to `pdu`. Returns false if one of the registers does not exist.
  bool append_values(Bytes& pdu, std::uint16_t first, std::size_t count, bool holding) const;
  void store(std::uint16_t first, std::span<const std::uint8_t> data);

  std::map<std::uint16_t, Holding> holding_;
  std::map<std::uint16_t, std::uint16_t> input_;
  std::map<std::uint16_t, bool> coils_;
  std::map<std::uint16_t, bool> discrete_inputs_;
  std::set<std::uint8_t> functions_;
};

}  // namespace softgrip::modbus
