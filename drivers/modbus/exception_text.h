#pragma once
// Provides the texts of Modbus exceptions without allocating memory.

namespace softgrip::drivers {

/// Returns the text of a Modbus exception.
[[nodiscard]] const char* text_of_exception(unsigned code) noexcept;

}  // namespace softgrip::drivers
