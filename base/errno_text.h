#pragma once
// Texts of errors without allocation.

#include <cstring>

namespace softgrip {

/// Text of an errno, from a table in the C library.
[[nodiscard]] inline const char* text_of_errno(int error) noexcept {
  const char* text = ::strerrordesc_np(error);
  return text != nullptr ? text : "unknown error";
}

}  // namespace softgrip
