#pragma once
// The pressure that the model says a reference needs.

#include <array>
#include <cstdint>
#include <string>

#include "model/blocks/bouc_wen.h"

namespace softgrip::control {

enum class FeedforwardKind : std::uint8_t {
  none,      ///< PID alone
  bouc_wen,  ///< inverse of the Bouc-Wen element alone, in parallel with the PID (Zhang et al. 2025, section
             ///< 5)
  full_model,  ///< inverse of the whole chain: implicit solve, lead for lag, preview for delay
  planned,     ///< computed before the run by least squares over the reference; needs no inverse
};

/// How rig files and options write the kinds, in their order. One is named after the block that it undoes.
inline constexpr std::array<std::string_view, 4> feedforward_names{"none", model::BoucWen<double>::info.id,
                                                                   "full_model", "planned"};
[[nodiscard]] constexpr std::string_view name_of(FeedforwardKind kind) {
  return feedforward_names.at(static_cast<std::size_t>(kind));
}

struct FeedforwardSettings {
  FeedforwardKind kind = FeedforwardKind::none;
  /// Time from the computation of a command until the board puts it out, beyond what the model's own valve
  /// blocks say: the bus exchange, the board's conversion. full_model looks further ahead by it. 0 to 1.
  double extra_latency_s = 0;
};

}  // namespace softgrip::control
