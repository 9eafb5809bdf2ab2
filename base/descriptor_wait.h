#pragma once
// Waits for a descriptor until a point in time.

#include <cstdint>

#include "base/time.h"

namespace softgrip {

enum class Waited : std::uint8_t {
  ready,      ///< also after an error or a hang-up, which the next call reports
  timed_out,  ///< the deadline has passed
  failed,     ///< errno contains the reason
};

/// Waits for events of poll() until `deadline` on CLOCK_BOOTTIME. select() would not accept descriptors above
/// 1023.
[[nodiscard]] Waited wait_for(int descriptor, short events, Nanoseconds deadline) noexcept;

}  // namespace softgrip
