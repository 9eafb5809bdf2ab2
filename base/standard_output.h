#pragma once
// Results on the standard output.

#include "base/exit_code.h"

namespace softgrip {

/// To be called at the end of a program: hands over all that was printed. Returns `code`; or, if the standard
/// output did not take all of it (a full disk, a closed pipe), a sentence goes to the standard error, and
/// done becomes io.
[[nodiscard]] ExitCode with_output_checked(ExitCode code, const char* program) noexcept;

}  // namespace softgrip
