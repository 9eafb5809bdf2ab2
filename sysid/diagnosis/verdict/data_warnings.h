#pragma once
// Adds warnings to a diagnosis, about limits of the data and about the refitted model.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/scales.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Adds a warning if the refitted model is unphysical.
void warn_unphysical(const model::Model& model, std::vector<std::string>& warnings);

/// Adds warnings about limits of the data that restrict the diagnosis.
void warn_of_data(const std::vector<Log>& logs, const Scales& scales, std::vector<std::string>& warnings);

/// Adds a warning if the readings are larger or smaller than the predictions of the given model by a factor
/// that corresponds to a wrong unit.
/// @param residual_mm  reading minus prediction, one vector per record
void warn_of_scale(const std::vector<Record>& records, const std::vector<std::vector<double>>& residual_mm,
                   std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
