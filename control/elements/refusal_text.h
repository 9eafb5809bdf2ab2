#pragma once
// Gives the message for a refused request.

#include <string_view>

#include "control/elements/fault.h"

namespace softgrip::control {

struct RefusalText {
  std::string_view meaning;  ///< one sentence
  std::string_view next;     ///< what to do now, with the command that does it
};

/// Of `none` and unknown numbers: that there is no reason, and nothing to do.
[[nodiscard]] const RefusalText& text_of(RefusalCode code) noexcept;

}  // namespace softgrip::control
