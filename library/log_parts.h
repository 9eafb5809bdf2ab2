#pragma once
// Checks public logs and converts them to the logs of sysid/.
// Converts the scores and intervals of sysid/ to the structs of the public interface.

#include <optional>
#include <string>
#include <vector>

#include "library/include/softgrip/identify.h"
#include "library/include/softgrip/log.h"
#include "sysid/fitting/interval.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace softgrip::library {

/// The unit that all logs of a call must have.
struct NeededUnit {
  std::string of;  ///< name of the object that determines the unit, for messages, for example "the model
                   ///< NAME"
  Unit unit = Unit::mm;
};

/// Returns the unit of a model. All logs for this model must have this unit.
[[nodiscard]] NeededUnit needed_for(const Model& model);

/// Converts public logs to logs of sysid/, after the checks that the `softgrip` commands make. Throws
/// InvalidArgument if a log fails a check.
/// @param argument       name of the argument, for messages
/// @param measured_stay  see sysid::begin_before_first_command()
[[nodiscard]] std::vector<sysid::Log> checked_logs(const std::string& argument, const std::vector<Log>& logs,
                                                   const LogUse& use, bool measured_stay,
                                                   const std::optional<NeededUnit>& needed);

[[nodiscard]] sysid::RecordOptions record_options(const LogUse& use);

[[nodiscard]] std::vector<Prediction> predictions_of(const std::vector<sysid::Record>& records,
                                                     const std::vector<sysid::Score>& scores);
[[nodiscard]] std::optional<Interval> interval_of(const std::optional<sysid::Interval>& interval);

}  // namespace softgrip::library
