#pragma once
// Returns the next step for the user if the board cannot be reached.

#include <string_view>

namespace softgrip::tools::doctor {

/// `failure_kind` is the name of a drivers::BusStatus. A running daemon reports the same names.
[[nodiscard]] std::string_view bus_advice(std::string_view failure_kind) noexcept;

}  // namespace softgrip::tools::doctor
