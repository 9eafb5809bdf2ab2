#pragma once
// Advises the user if the board cannot be reached.

#include <string_view>

namespace softgrip::tools::doctor {

/// Returns the next step for a failure. `failure_kind` is the name of a drivers::BusStatus, which a running
/// daemon also reports.
[[nodiscard]] std::string_view bus_advice(std::string_view failure_kind) noexcept;

}  // namespace softgrip::tools::doctor
