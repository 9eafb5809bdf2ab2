#pragma once
// Returns the message for a refused request.

#include <string_view>

#include "control/elements/fault.h"

namespace softgrip::control {

struct RefusalText {
  std::string_view meaning;  ///< reason for the refusal in one sentence
  std::string_view next;     ///< the next action of the user, with its command
};

/// Returns the texts for a code. For `none` and for unknown numbers, the text says that there is no reason.
[[nodiscard]] const RefusalText& text_of(RefusalCode code) noexcept;

}  // namespace softgrip::control
