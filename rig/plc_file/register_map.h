#pragma once
// Defines the register map of the PLC interface, as config/plc.yaml gives it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "document/reader.h"

namespace softgrip::plc {

/// The names of all registers. A register whose name begins with finger_ exists once per finger.
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

/// The three blocks of registers in the file: registers that the PLC writes (command), registers that the
/// gateway writes (status), and registers that exist once per finger (finger).
enum class Block : std::uint8_t { command, status, finger };

struct RegisterInfo {
  Name name;
  Block block;
  std::string_view key;   ///< name of the register in its block of the file
  std::string_view unit;  ///< unit of a physical quantity; empty for a code or a counter
};
/// Returns the descriptions of all registers in the order of Name.
[[nodiscard]] const std::array<RegisterInfo, name_count>& registers() noexcept;

struct RegisterMap {
  std::array<std::uint16_t, name_count> address{};  ///< address of each register; for a register of a finger,
                                                    ///< the offset from the address of the finger's first
                                                    ///< register
  std::array<double, name_count> resolution{};  ///< resolution of each quantity: the physical value that the
                                                ///< register value 1 represents, in the unit of the quantity
  std::uint16_t first_finger = 0;
  std::uint16_t finger_stride = 0;
  std::uint16_t most_fingers = 0;

  [[nodiscard]] std::uint16_t at(Name name) const noexcept { return address[static_cast<std::size_t>(name)]; }
  /// Returns the address of a finger's register: `name` is the register and `finger` the index of the finger.
  [[nodiscard]] std::uint16_t at(Name name, std::size_t finger) const noexcept {
    return static_cast<std::uint16_t>(first_finger + finger_stride * finger + at(name));
  }
  [[nodiscard]] double of_one(Name name) const noexcept { return resolution[static_cast<std::size_t>(name)]; }
};

/// Reads the register map from the key `registers`. The file must contain each register, and no two registers
/// may have the same address.
[[nodiscard]] RegisterMap read_register_map(const document::Document& document, const document::Node& node,
                                            document::Problems& problems);

}  // namespace softgrip::plc
