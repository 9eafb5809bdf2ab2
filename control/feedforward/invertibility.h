#pragma once
// Checks if a feedforward is possible for a model. The check runs once when a rig is loaded.
// Finds the part of a model that can be inverted, if the whole model has no inverse.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "control/elements/feedforward.h"
#include "control/elements/limits.h"
#include "model/block.h"
#include "model/model.h"

namespace softgrip::control {

/// The reason for which a feedforward is refused, as a text for the user.
struct Refusal {
  std::string text;
  std::string_view advice = {};  ///< proposed action; empty if `text` needs no proposal

  [[nodiscard]] std::string with_advice() const;
};

/// Checks that `settings.kind` can be computed for `model` over the working range, in every hysteresis state
/// that the model can reach. The working range goes from 0 kPa to pressure_max_kpa. If pressure_min_kpa is
/// below 0, the working range starts at pressure_min_kpa. A refusal names the block or the parameter values
/// that prevent the feedforward. With every kind, the settled displacement of a model with an element must
/// rise with the command, because the feedback of the controller would be unstable otherwise.
[[nodiscard]] tl::expected<void, Refusal> check_feedforward(const model::Model& model,
                                                            const FeedforwardSettings& settings,
                                                            const LimitSettings& limits, double tick_s);

/// Returns the names of the blocks that the kind full_model cannot invert, as the text "`a`, `b`".
[[nodiscard]] std::string not_undone(std::span<const model::BlockInfo> blocks);

struct InvertiblePart {
  model::Model model;
  std::vector<std::string> left_out;  ///< ids of the blocks that were removed from the model
};

/// Returns the model without the blocks that prevent `full_model`. First, the blocks without an inverse are
/// removed. If `full_model` is still impossible, one more block is removed: the block with the smallest
/// effect among those whose removal makes `full_model` possible. The effect of a block is measured on a slow
/// path from 0 kPa to each end of the pressure range and back, twice. Returns an empty value if `full_model`
/// is possible for the unchanged model, or impossible after every removal.
[[nodiscard]] std::optional<InvertiblePart> invertible_part(const model::Model& model,
                                                            const LimitSettings& limits, double tick_s);

}  // namespace softgrip::control
