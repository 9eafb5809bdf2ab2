#pragma once
// The register map of the PLC interface, as config/plc.yaml defines it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "document/reader.h"

namespace softgrip::plc {

/// All registers. Those of a finger exist once per finger.
enum class Name : std::uint8_t {
  command_counter,
  command,
  recipe,
  squeeze,
  speed,
  displacement,
  master_heartbeat,
  map_version,
  done_counter,
  outcome,
  reason,
  state,
  result,
  fault,
  step,
  fingers,
  heartbeat,
  master,
  finger_result,
  finger_displacement,
  finger_pressure,
  finger_command,
  finger_squeeze,
  finger_valid,
};
inline constexpr std::size_t name_count = static_cast<std::size_t>(Name::finger_valid) + 1;

/// The blocks of the file: registers that the PLC writes, registers that the gateway writes, registers per
/// finger.
enum class Block : std::uint8_t { command, status, finger };

struct RegisterInfo {
  Name name;
  Block block;
  std::string_view key;   ///< key in the file, without its block
  std::string_view unit;  ///< unit of a quantity; empty for a code or a count
};
/// Returns the registers in the order of Name.
[[nodiscard]] const std::array<RegisterInfo, name_count>& registers() noexcept;

struct RegisterMap {
  std::array<std::uint16_t, name_count> address{};  ///< of a finger: offset from its first
  std::array<double, name_count> resolution{};      ///< for a quantity: size of one count, in its unit
  std::uint16_t first_finger = 0;
  std::uint16_t finger_stride = 0;
  std::uint16_t most_fingers = 0;

  [[nodiscard]] std::uint16_t at(Name name) const noexcept { return address[static_cast<std::size_t>(name)]; }
  /// Returns the address of a register of one finger.
  [[nodiscard]] std::uint16_t at(Name name, std::size_t finger) const noexcept {
    return static_cast<std::uint16_t>(first_finger + finger_stride * finger + at(name));
  }
  [[nodiscard]] double of_one(Name name) const noexcept { return resolution[static_cast<std::size_t>(name)]; }
};

/// Reads the map under `registers`. Each register must be present, and no two may share an address.
[[nodiscard]] RegisterMap read_register_map(const document::Document& document, const document::Node& node,
                                            document::Problems& problems);

}  // namespace softgrip::plc
