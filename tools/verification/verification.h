#pragma once
// A report of identify, validate or diagnose, computed again from what its folder says it was made of.

#include <string>
#include <vector>

#include "tools/verification/comparison.h"

namespace softgrip::tools {

struct Verification {
  /// Sentences: what cannot be computed again, and why (a log that is not there or is another one, a folder
  /// that does not say how it was made). Where there are any, nothing was compared.
  std::vector<std::string> missing;
  std::string reported_by;  ///< software and version
  std::string recomputed_by;
  Comparison comparison;
};

/// Calls the command that made `folder` once more, into a folder that is removed afterwards, and compares its
/// JSON, its series and its model. Logs and models are looked for where they were named, then in `folder` and
/// beside it; each must have the hash that the report names.
/// @param program  of softgrip. @param tolerance  relative
[[nodiscard]] Verification verify_report(const std::string& folder, const std::string& program,
                                         double tolerance);

}  // namespace softgrip::tools
