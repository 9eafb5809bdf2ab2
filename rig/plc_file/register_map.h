#pragma once
// Which register stands for what: the contract with the PLC, as config/plc.yaml writes it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "document/reader.h"

namespace softgrip::plc {

/// Every register that there is; those of a finger once per finger.
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

/// In the file's words: who writes it, or that it is there once per finger.
enum class Block : std::uint8_t { command, status, finger };

struct RegisterInfo {
  Name name;
  Block block;
  std::string_view key;   ///< in the file, without its block
  std::string_view unit;  ///< of a quantity; empty for a code or a count
};
/// In the order of Name.
[[nodiscard]] const std::array<RegisterInfo, name_count>& registers() noexcept;

struct RegisterMap {
  std::array<std::uint16_t, name_count> address{};  ///< of a finger's: from its first
  std::array<double, name_count> resolution{};      ///< of a quantity: what one count is, in its unit
  std::uint16_t first_finger = 0;
  std::uint16_t finger_stride = 0;
  std::uint16_t most_fingers = 0;

  [[nodiscard]] std::uint16_t at(Name name) const noexcept { return address[static_cast<std::size_t>(name)]; }
  /// Of a finger's register.
  [[nodiscard]] std::uint16_t at(Name name, std::size_t finger) const noexcept {
    return static_cast<std::uint16_t>(first_finger + finger_stride * finger + at(name));
  }
  [[nodiscard]] double of_one(Name name) const noexcept { return resolution[static_cast<std::size_t>(name)]; }
};

/// The map under `registers`; every register must be there, no two at one address.
[[nodiscard]] RegisterMap read_register_map(const document::Document& document, const document::Node& node,
                                            document::Problems& problems);

}  // namespace softgrip::plc
