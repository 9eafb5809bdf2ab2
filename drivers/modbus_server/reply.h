#pragma once
// The bytes that a client receives, and the times at which they are sent. The emulator also expresses faults
// of the wire in these types.

#include <chrono>
#include <vector>

#include "drivers/modbus_server/requests.h"

namespace softgrip::modbus {

/// Bytes that are sent `after` the arrival of their request.
struct Piece {
  std::chrono::nanoseconds after{0};
  Bytes bytes;
};

/// The complete reaction to one request. If the board does not respond, `pieces` is empty.
struct Reply {
  std::vector<Piece> pieces;
  bool disconnect = false;  ///< close the connection after all pieces are sent
};

}  // namespace softgrip::modbus
