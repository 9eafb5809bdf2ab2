#pragma once
// Describes errno values without allocating memory.

#include <cstring>

namespace softgrip {

/// Returns the description of an errno value from a constant table in the C library.
[[nodiscard]] inline const char* text_of_errno(int error) noexcept {
  const char* text = ::strerrordesc_np(error);
  return text != nullptr ? text : "unknown error";
}

}  // namespace softgrip
