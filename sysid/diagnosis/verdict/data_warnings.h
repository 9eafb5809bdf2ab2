#pragma once
// What a diagnosis says beside its verdict: limits of the data, and of a recalibrated model.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/scales.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// What recalibration cannot be trusted with.
void warn_unphysical(const model::Model& model, std::vector<std::string>& warnings);

/// Limits of the data that bear on what can be told.
void warn_of_data(const std::vector<Log>& logs, const Scales& scales, std::vector<std::string>& warnings);

/// Readings that are as many times what the given model says as two units are apart.
/// @param residual_mm  reading minus prediction, by record
void warn_of_scale(const std::vector<Record>& records, const std::vector<std::vector<double>>& residual_mm,
                   std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
