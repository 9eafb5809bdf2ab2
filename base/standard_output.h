#pragma once
// Checks that a program could write its results to the standard output.

#include "base/exit_code.h"

namespace softgrip {

/// Flushes the standard output at the end of a program. Returns `code` if all output was written. If output
/// was lost (a full disk, a closed pipe), prints a message to the standard error, and returns `io` if `code`
/// is `done`.
[[nodiscard]] ExitCode with_output_checked(ExitCode code, const char* program) noexcept;

}  // namespace softgrip
