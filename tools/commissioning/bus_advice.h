#pragma once
// The next step for a board that is not reached.

#include <string_view>

namespace softgrip::tools::doctor {

/// `failure_kind`: the name of a drivers::BusStatus, as a running daemon states it, too.
[[nodiscard]] std::string_view bus_advice(std::string_view failure_kind) noexcept;

}  // namespace softgrip::tools::doctor
