#pragma once
// Signals as MATLAB's .mat, through libmatio.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/exporting/signals.h"

namespace softgrip::tools {

/// Writes a file of version 5, packed: time_s and a column vector per signal of numbers. Texts are left out;
/// their names are returned. The same signals give the same bytes. The error is a sentence.
[[nodiscard]] tl::expected<std::vector<std::string>, std::string> write_mat(const std::string& path,
                                                                            const SignalGroup& group);

/// A name that MATLAB takes: letters, digits and underscores, a letter first, at most 63 of them.
[[nodiscard]] std::string matlab_name(const std::string& name);

}  // namespace softgrip::tools
