#pragma once
// Imports the names of drivers/modbus_server/ into the namespace of the emulator.

#include "drivers/modbus_server/connection.h"
#include "drivers/modbus_server/registers.h"
#include "drivers/modbus_server/requests.h"

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

}  // namespace softgrip::simulation
