#pragma once
// Adds warnings to a diagnosis, about limits of the data and about the refitted model.
// Handles causes that a simulation of the logs cannot detect. Either the logs do not contain the condition in
// which the cause has an effect, or the logs were recorded in a closed loop.
// Averages logs that have far more samples than a diagnosis needs, because the computing time grows with the
// number of readings. Several readings within the response time of a finger contain no more information than
// their average.

#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/scales.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
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

/// Corrects the causes that a search has named. A drift of the sensor is visible only while the finger rests
/// without pressure. If no log contains such a rest, the drift is moved from `causes` to `partial` and listed
/// in `not_tested`. If every log was recorded in a closed loop, a warning is added. If the phase of each loop
/// is that of a sticking valve (sysid/evidence/loop_phase.h), valve_deadband is named, and the causes of the
/// search are moved to `partial`.
void correct_by_logs(Diagnosis& diagnosis, const std::vector<Log>& logs);

/// Longest time over which neighbouring readings are averaged [s]: half a sample interval at 100 Hz.
inline constexpr double averaged_interval_s = 0.005;

/// Averages the records if they have more readings than enough_readings (`sysid/logs/resampled_record.h`),
/// and adds one sentence per averaged record to `warnings`. Returns true if any record was averaged.
bool average_dense(std::vector<Record>& records, std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
