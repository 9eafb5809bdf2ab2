#pragma once
// Writes signals as a MATLAB .mat file with libmatio.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/exporting/signals.h"

namespace softgrip::tools {

/// The bytes of a .mat file, and the names of the omitted signals, whose values are texts.
struct MatBytes {
  std::string bytes;
  std::vector<std::string> left_out;
};

/// Returns a compressed file of version 5 with time_s and one column vector per numeric signal. The bytes are
/// read back and compared with the signals. Equal signals give equal bytes. The error is a sentence.
[[nodiscard]] tl::expected<MatBytes, std::string> mat_bytes(const SignalGroup& group);

/// Returns `name` as a name that MATLAB accepts: at most 63 letters, digits and underscores. The first
/// character is a letter.
[[nodiscard]] std::string matlab_name(const std::string& name);

}  // namespace softgrip::tools
