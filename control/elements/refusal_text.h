#pragma once
// Gives the message for a refused request.

#include <string_view>

#include "control/elements/fault.h"

namespace softgrip::control {

struct RefusalText {
  std::string_view meaning;  ///< one sentence
  std::string_view next;     ///< next action, with its command
};

/// Returns the texts for a code. For `none` and unknown numbers they state that there is no reason.
[[nodiscard]] const RefusalText& text_of(RefusalCode code) noexcept;

}  // namespace softgrip::control
