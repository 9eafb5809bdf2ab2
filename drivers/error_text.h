#pragma once
// Texts of errors without allocation.

namespace softgrip::drivers {

/// Text of an errno, from a table in the C library.
[[nodiscard]] const char* text_of_errno(int error) noexcept;

/// Text of a Modbus exception.
[[nodiscard]] const char* text_of_exception(unsigned code) noexcept;

}  // namespace softgrip::drivers
