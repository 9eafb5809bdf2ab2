#pragma once
// Returns the message for a refused request.

#include <string_view>

#include "control/elements/fault.h"

namespace softgrip::control {

struct RefusalText {
  std::string_view meaning;  ///< reason for the refusal in one sentence
  std::string_view next;     ///< action that the user should take next, with the command for this action
};

/// Returns the texts for the code of a refusal. For `none` and for unknown codes, the text says that the
/// request was not refused.
[[nodiscard]] const RefusalText& text_of(RefusalCode code) noexcept;

}  // namespace softgrip::control
