#pragma once
// Waits until a descriptor is ready or a deadline has passed.

#include <cstdint>

#include "base/time.h"

namespace softgrip {

enum class Waited : std::uint8_t {
  ready,      ///< the descriptor is ready, or has an error or a hang-up, which the next call on the
              ///< descriptor reports
  timed_out,  ///< the deadline has passed before the descriptor was ready
  failed,     ///< waiting failed; errno contains the reason
};

/// Waits for events of poll() until `deadline` on CLOCK_BOOTTIME. select() is not used, because it does not
/// accept descriptors above 1023.
[[nodiscard]] Waited wait_for(int descriptor, short events, Nanoseconds deadline) noexcept;

}  // namespace softgrip
