#pragma once
// Signals as MATLAB's .mat, through libmatio.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/exporting/signals.h"

namespace softgrip::tools {

/// The bytes of a .mat file, and the names of the signals that it leaves out because they are texts.
struct MatBytes {
  std::string bytes;
  std::vector<std::string> left_out;
};

/// Makes a file of version 5, compressed: time_s and a column vector per signal of numbers. The bytes are
/// read back and compared with the signals. The same signals give the same bytes. The error is a sentence.
[[nodiscard]] tl::expected<MatBytes, std::string> mat_bytes(const SignalGroup& group);

/// A name that MATLAB takes: letters, digits and underscores, a letter first, at most 63 of them.
[[nodiscard]] std::string matlab_name(const std::string& name);

}  // namespace softgrip::tools
