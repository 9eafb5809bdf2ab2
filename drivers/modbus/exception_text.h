#pragma once
// Texts of Modbus exceptions without allocation.

namespace softgrip::drivers {

/// Text of a Modbus exception.
[[nodiscard]] const char* text_of_exception(unsigned code) noexcept;

}  // namespace softgrip::drivers
