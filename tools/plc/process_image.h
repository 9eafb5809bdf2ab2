#pragma once
// Between the daemon's JSON and registers. No sockets.

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

/// All registers of the map, at their values before anything is known.
[[nodiscard]] modbus::Registers make_registers(const RegisterMap& map);

/// A quantity as a signed 16-bit count, clamped; no_value where it is not a number.
[[nodiscard]] std::uint16_t counts_of(const nlohmann::ordered_json& value, double resolution);

/// Writes a status of the daemon into the registers.
void show_status(const nlohmann::ordered_json& status, const RegisterMap& map, modbus::Registers& registers);
/// The daemon does not answer: its state is no_daemon, results and readings are unknown.
void show_no_daemon(const RegisterMap& map, modbus::Registers& registers);

/// The request to the daemon that a command stands for, or why there is none.
[[nodiscard]] tl::expected<nlohmann::ordered_json, Reason> request_of(const Settings& settings,
                                                                      const Command& command);
/// The daemon's word for what is to be done.
[[nodiscard]] const char* command_of(CommandCode code) noexcept;
/// Why the daemon refused: its `error`.
[[nodiscard]] Reason reason_of(const nlohmann::ordered_json& error);

/// Whether a request that was answered without an exception writes that register.
[[nodiscard]] bool writes(std::span<const std::uint8_t> pdu, std::uint16_t address) noexcept;

}  // namespace softgrip::plc
