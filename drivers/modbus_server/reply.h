#pragma once
// Defines the bytes that a client receives, and the times at which the server sends these bytes. The emulator
// also uses these types to simulate transmission faults.

#include <chrono>
#include <vector>

#include "drivers/modbus_server/requests.h"

namespace softgrip::modbus {

/// Bytes of a reply that are sent when the time `after` has passed since the arrival of the request.
struct Piece {
  std::chrono::nanoseconds after{0};
  Bytes bytes;
};

/// The complete response to one request. If the board does not respond to the request, `pieces` is empty.
struct Reply {
  std::vector<Piece> pieces;
  bool disconnect = false;  ///< true: the connection is closed after all pieces are sent
};

}  // namespace softgrip::modbus
