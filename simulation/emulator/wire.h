#pragma once
// Imports the names of drivers/modbus_server/ into the namespace of the emulator.
// Changes a correct reply according to a fault of the transmission.

#include "base/time.h"
#include "drivers/modbus_server/connection.h"
#include "drivers/modbus_server/registers.h"
#include "drivers/modbus_server/requests.h"
#include "simulation/emulator/fault.h"

namespace softgrip::simulation {

using modbus::append_word;
using modbus::Bytes;
using modbus::Clock;
using modbus::Connection;
using modbus::exception_reply;
using modbus::frame_on;
using modbus::max_pdu;
using modbus::Piece;
using modbus::Registers;
using modbus::Reply;
using modbus::Request;
using modbus::Wire;
using modbus::WireTime;
using modbus::word_at;

/// Returns the reply without any fault, as one piece that is sent without delay.
[[nodiscard]] Reply good_reply(Wire wire, const Request& request, const Bytes& pdu);

/// Returns true if the fault `fault` of the transmission affects a request. `connected_for` is the time from
/// the opening of the connection to the arrival of the request.
[[nodiscard]] bool touches(const FaultSpec& fault, const Request& request,
                           Nanoseconds connected_for) noexcept;

/// Returns true if the board executes a request that a fault of the kind `kind` affects.
[[nodiscard]] bool carried_out(FaultKind kind) noexcept;

/// Returns the faulty reply that the client receives in place of good_reply(wire, request, pdu). A frame on a
/// serial line contains no transaction id and no length. Therefore, on a serial line, wrong_transaction
/// causes a wrong checksum, and wrong_length adds five bytes. The client would discard fewer than five extra
/// bytes as stray bytes.
[[nodiscard]] Reply spoiled_reply(Wire wire, const FaultSpec& fault, const Request& request,
                                  const Bytes& pdu);

}  // namespace softgrip::simulation
