#pragma once
// Recomputes a report of identify, validate or diagnose from the inputs that the report names.

#include <string>
#include <vector>

#include "tools/verification/comparison.h"

namespace softgrip::tools {

struct Verification {
  /// Sentences about inputs that prevent the comparison: a log that is missing or has changed, or a report
  /// that does not state its command line. If the list is not empty, nothing was compared.
  std::vector<std::string> missing;
  std::string reported_by;  ///< software and version that wrote the report
  std::string recomputed_by;
  Comparison comparison;
};

/// Repeats the command that wrote `folder` in a temporary folder, and compares the JSON result, the series
/// and the model of the two runs. Searches logs and models at their original paths, in `folder`, and in the
/// folder that contains `folder`. The hash of each file must equal the hash that the report states for this
/// file.
/// @param program    path of the program softgrip.
/// @param tolerance  relative tolerance.
[[nodiscard]] Verification verify_report(const std::string& folder, const std::string& program,
                                         double tolerance);

}  // namespace softgrip::tools
