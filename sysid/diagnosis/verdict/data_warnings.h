#pragma once
// Adds warnings to a diagnosis: about insufficient or implausible data, and about an unphysical refitted
// model.
// Tests if a model can explain the logs, and if one set of parameters fits all logs together.
// Handles causes that a simulation of the logs cannot detect. Either no log contains the condition under
// which the cause has an effect, or the logs were recorded in a closed loop.
// Averages logs with far more samples than a diagnosis needs, because the computing time increases with the
// number of readings. Within the response time of a finger, the mean of several readings contains as much
// information as the readings.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/scales.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Returns a warning if the refitted model explains less than 20 % of the variance of the readings.
[[nodiscard]] std::optional<std::string> why_not_about(const std::vector<Record>& records,
                                                       const StructureFit& recalibrated);

/// Returns a warning if the logs are inconsistent, for example because they come from two rigs or because the
/// rig was changed between two logs. The structure is fitted to each log separately. The logs are
/// inconsistent if the mean square error of these fits is below 10 % of `together_mm2`.
/// @param together_mm2  mean square error of a common fit with all causes that were found. It includes the
/// causes because a drift, for example, makes logs differ, but is explained by a cause.
[[nodiscard]] std::optional<std::string> inconsistent_among(const std::vector<Record>& records,
                                                            const StructureFit& recalibrated,
                                                            double together_mm2);

/// Adds a warning if the refitted model is unphysical.
void warn_unphysical(const model::Model& model, std::vector<std::string>& warnings);

/// Adds warnings about properties of the logs that limit the diagnosis, for example missing columns.
void warn_of_data(const std::vector<Log>& logs, const Scales& scales, std::vector<std::string>& warnings);

/// Adds a warning if the readings differ from the predictions of the given model by a factor that a wrong
/// unit would cause.
/// @param residual_mm  reading minus prediction, one vector per record
void warn_of_scale(const std::vector<Record>& records, const std::vector<std::vector<double>>& residual_mm,
                   std::vector<std::string>& warnings);

/// Corrects the causes that a search has named, in three steps:
/// - A drift of the sensor is visible only while the finger rests without pressure. If no log contains such a
///   rest, the drift is moved from `causes` to `partial` and listed in `not_tested`.
/// - If every log was recorded in a closed loop, a warning is added.
/// - If, in addition, a sticking valve explains the readings of each loop best (shown_stiction()),
///   valve_deadband is named and `loop_bands_kpa` is set. The other causes of the search are then moved to
///   `partial`.
/// @param responses  returns the readings that the refitted model predicts, one value per row of each log. It
/// is called only for closed loops. If the result is empty, the hysteresis of the model is not compared with
/// a sticking valve.
void correct_by_logs(Diagnosis& diagnosis, const std::vector<Log>& logs,
                     const std::function<std::vector<std::vector<double>>()>& responses);

/// Longest time over which consecutive readings are averaged, in units of time_unit_s(). For a finger, it is
/// half of the sampling interval at 100 Hz.
inline constexpr double averaged_interval_in_units = 0.005;

/// Averages the records if they have more readings than enough_readings (`sysid/logs/resampled_record.h`).
/// Adds one sentence to `warnings` for each averaged record. Returns true if at least one record was
/// averaged.
bool average_dense(std::vector<Record>& records, std::vector<std::string>& warnings);

}  // namespace softgrip::sysid
