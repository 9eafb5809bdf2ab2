#pragma once
// Converts between the daemon's JSON and registers. No sockets.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "drivers/modbus_server/registers.h"
#include "rig/plc_file/settings.h"
#include "tools/plc/codes.h"
#include "tools/plc/handshake.h"

namespace softgrip::plc {

/// Returns all registers of the map with their initial values.
[[nodiscard]] modbus::Registers make_registers(const RegisterMap& map);

/// Returns a quantity as a signed 16-bit count, clamped to its range, or no_value if it is not a number.
[[nodiscard]] std::uint16_t counts_of(const nlohmann::ordered_json& value, double resolution);

/// Writes a status of the daemon into the registers.
void show_status(const nlohmann::ordered_json& status, const RegisterMap& map, modbus::Registers& registers);
/// Writes the registers for a missing daemon: the state is no_daemon, and results and readings are unknown.
void show_no_daemon(const RegisterMap& map, modbus::Registers& registers);

/// Returns the request to the daemon for a command, or the reason for refusing it.
[[nodiscard]] tl::expected<nlohmann::ordered_json, Reason> request_of(const Settings& settings,
                                                                      const Command& command);
/// Returns the name of the daemon's command.
[[nodiscard]] const char* command_of(CommandCode code) noexcept;
/// Returns the reason code for the daemon's `error`.
[[nodiscard]] Reason reason_of(const nlohmann::ordered_json& error);

/// Returns true if a request that was answered without an exception writes this register.
[[nodiscard]] bool writes(std::span<const std::uint8_t> pdu, std::uint16_t address) noexcept;

}  // namespace softgrip::plc
