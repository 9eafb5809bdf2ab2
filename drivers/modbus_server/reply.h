#pragma once
// The bytes that a client receives, and the times at which they are sent. The emulator also uses these types
// to simulate faults of the transmission.

#include <chrono>
#include <vector>

#include "drivers/modbus_server/requests.h"

namespace softgrip::modbus {

/// Bytes of a reply that are sent at the time `after`, measured from the arrival of the request.
struct Piece {
  std::chrono::nanoseconds after{0};
  Bytes bytes;
};

/// The complete response to one request. If the board does not respond, `pieces` is empty.
struct Reply {
  std::vector<Piece> pieces;
  bool disconnect = false;  ///< true: the connection is closed after all pieces are sent
};

}  // namespace softgrip::modbus
