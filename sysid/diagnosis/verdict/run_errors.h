#pragma once
// Computes the error of each run for the models that a diagnosis compares.

#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

/// Returns the RMSE of each run. If there is a single run, returns the RMSE of each half.
/// @param by_unit  result of divide_by_unit() for the records. The losses must have been computed for its
/// blocks.
[[nodiscard]] std::vector<RunError> run_errors(const std::vector<Record>& records, const Division& by_unit,
                                               const BlockLosses& given, const BlockLosses& recalibrated,
                                               const BlockLosses& extended);

}  // namespace softgrip::sysid
