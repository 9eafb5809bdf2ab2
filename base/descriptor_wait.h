#pragma once
// Waiting for a descriptor until a point in time.

#include <cstdint>

#include "base/time.h"

namespace softgrip {

enum class Waited : std::uint8_t {
  ready,      ///< or an error or a hang-up, which the call that follows names
  timed_out,  ///< the deadline passed
  failed,     ///< errno says why
};

/// Waits for poll events until `deadline` on CLOCK_BOOTTIME. poll, not select: descriptors of 1024 and above
/// are as good as any other.
[[nodiscard]] Waited wait_for(int descriptor, short events, Nanoseconds deadline) noexcept;

}  // namespace softgrip
