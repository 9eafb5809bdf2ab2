#pragma once
// What goes back to a client, and when: the unit in which wire faults are expressed.

#include <chrono>
#include <vector>

#include "drivers/modbus_server/requests.h"

namespace softgrip::modbus {

/// Bytes that leave `after` their request came in.
struct Piece {
  std::chrono::nanoseconds after{0};
  Bytes bytes;
};

/// The whole reaction to one request. No piece at all is a board that does not answer.
struct Reply {
  std::vector<Piece> pieces;
  bool disconnect = false;  ///< close the connection once all pieces are out
};

}  // namespace softgrip::modbus
