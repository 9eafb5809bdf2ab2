#pragma once
// Returns advice for the user if the board cannot be reached.

#include <string_view>

namespace softgrip::tools::doctor {

/// Returns the next step that the user should take after a bus failure. `failure_kind` is the name of a
/// drivers::BusStatus, which the status of a running daemon contains as well.
[[nodiscard]] std::string_view bus_advice(std::string_view failure_kind) noexcept;

}  // namespace softgrip::tools::doctor
