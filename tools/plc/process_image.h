#pragma once
// Converts between the JSON of the daemon and the Modbus registers. Uses no sockets.

#include <cstdint>
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

/// Returns a quantity as a signed 16-bit register value in units of `resolution`. A quantity outside the
/// range of the register is limited to this range. Returns no_value if the JSON value is not a number.
[[nodiscard]] std::uint16_t counts_of(const nlohmann::ordered_json& value, double resolution);

/// Writes a status of the daemon into the registers.
void write_status(const nlohmann::ordered_json& status, const RegisterMap& map, modbus::Registers& registers);
/// Writes the registers for the time in which no daemon is connected: the state is no_daemon, and results and
/// readings are unknown.
void write_no_daemon(const RegisterMap& map, modbus::Registers& registers);

/// Returns the request that must be sent to the daemon for a command. If the command is refused, returns the
/// reason.
[[nodiscard]] tl::expected<nlohmann::ordered_json, Reason> request_of(const Settings& settings,
                                                                      const Command& command);
/// Returns the name that the daemon's socket uses for a command.
[[nodiscard]] std::string_view command_of(CommandCode code) noexcept;
/// Returns the reason code for the member `error` of a daemon's response.
[[nodiscard]] Reason reason_of(const nlohmann::ordered_json& error);

/// Returns true if a request writes the register at `address`. The caller must know that the request was
/// executed without a Modbus exception.
[[nodiscard]] bool writes(std::span<const std::uint8_t> pdu, std::uint16_t address) noexcept;

}  // namespace softgrip::plc
