#pragma once
// Defines the settings of the feedforward. The feedforward is the part of the pressure command that the model
// computes from the reference.

#include <cstdint>
#include <string_view>

#include "base/enum_table.h"
#include "model/blocks/bouc_wen.h"

namespace softgrip::control {

enum class FeedforwardKind : std::uint8_t {
  none,        ///< no feedforward: only the PID controls the pressure
  bouc_wen,    ///< inverse of the Bouc-Wen element without the other elements (Zhang et al. 2025, section 5)
  full_model,  ///< inverse of the complete chain of blocks, with a lead for each lag and a preview for the
               ///< dead time
  planned,     ///< command computed by least squares over the reference before the sequence starts; needs no
               ///< inverse of the model
};

/// Names of the feedforward kinds in rig files and options. The kind `bouc_wen` has the name of the block
/// that it inverts.
inline constexpr auto feedforward_names =
    enum_names<FeedforwardKind>({{FeedforwardKind::none, "none"},
                                 {FeedforwardKind::bouc_wen, model::BoucWen<double>::info.id},
                                 {FeedforwardKind::full_model, "full_model"},
                                 {FeedforwardKind::planned, "planned"}});
[[nodiscard]] constexpr std::string_view name_of(FeedforwardKind kind) noexcept {
  return feedforward_names[kind];
}

struct FeedforwardSettings {
  FeedforwardKind kind = FeedforwardKind::none;
  /// Time from the computation of a command to the board's output [s]: the bus exchange and the board's
  /// conversion. The valve blocks of the model do not include this time. The kind `full_model` reads the
  /// reference this much further ahead. Range: 0 to 1.
  double extra_latency_s = 0;
};

}  // namespace softgrip::control
