#pragma once
// Identifies and validates a model with given logs. Outliers are removed from the readings first. The results
// also contain warnings about the data. `softgrip identify`, `softgrip validate` and the library call these
// functions.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "model/model.h"
#include "sysid/identification/identify.h"
#include "sysid/identification/identify_report.h"
#include "sysid/identification/validate.h"
#include "sysid/logs/log.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

/// The input of an identification.
struct IdentifyQuestion {
  std::vector<Log> logs;        ///< logs to fit; at least one
  std::vector<Log> validation;  ///< logs to predict
  /// Model to begin with; nullopt: the default structure, scaled to the data.
  std::optional<model::Model> start;
  std::string start_file;    ///< name of the file of `start`, for a warning
  std::size_t branches = 2;  ///< number of creep branches of the default structure
  /// If set, a structure is chosen automatically, and `start` is not used.
  std::optional<StructureQuestion> structure;
  IdentifyOptions options;
};

/// The result of an identification, with the logs in the form in which they were used.
struct IdentifiedLogs {
  std::vector<Log> logs;
  std::vector<Log> validation_logs;
  model::Model start;
  Identification result;
  std::vector<Record> validation_records;
  std::vector<Score> validation;
  std::uint64_t seed = 1;

  /// Returns a report, which refers to this object and must not outlive it.
  /// @param call  the command and its arguments; may be empty.
  [[nodiscard]] IdentifyReport report(std::vector<std::string> call) const;
};

/// Identifies a model. If the logs cannot be fitted, the error contains a sentence and the plausibility
/// warnings about the logs.
[[nodiscard]] tl::expected<IdentifiedLogs, std::string> identify_logs(IdentifyQuestion question);

/// Predicts the logs. Wrong readings are removed from `logs` before. The result contains a warning for each
/// log with such readings.
[[nodiscard]] Validation validate_given_logs(const model::Model& model, std::vector<Log>& logs,
                                             const RecordOptions& options);

}  // namespace softgrip::sysid
