#pragma once
// Identifies a model from logs, and validates a model with logs. Both functions first remove outliers from
// the readings. Both results contain warnings about the data. `softgrip identify`, `softgrip validate` and
// the library call these functions.

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

/// Returns one sentence for each type of motion that no log contains. The sentence names the fitted
/// parameters that cannot be determined without this type of motion.
[[nodiscard]] std::vector<std::string> excitation_limits(const std::vector<Log>& logs,
                                                         const std::vector<Estimate>& parameters);

/// Input data and options of an identification.
struct IdentifyQuestion {
  std::vector<Log> logs;        ///< logs to which the model is fitted; at least one
  std::vector<Log> validation;  ///< logs that the fitted model has to predict
  /// Initial model of the fit; nullopt: the default structure, scaled to the data.
  std::optional<model::Model> start;
  std::string start_file;    ///< name of the file that contains `start`, for a warning
  std::size_t branches = 2;  ///< number of creep branches of the default structure
  /// If set, the structure is chosen automatically, and `start` is not used.
  std::optional<StructureQuestion> structure;
  IdentifyOptions options;
};

/// Result of an identification, with the logs to which the model was fitted. These logs do not contain the
/// removed outliers.
struct IdentifiedLogs {
  std::vector<Log> logs;
  std::vector<Log> validation_logs;
  model::Model start;
  Identification result;
  std::vector<Record> validation_records;
  std::vector<Score> validation;
  std::uint64_t seed = 1;

  /// Returns a report. The report refers to this object and must not outlive it.
  /// @param call  command line of the user: the command and its arguments; may be empty.
  [[nodiscard]] IdentifyReport report(std::vector<std::string> call) const;
};

/// Identifies a model. If no model can be fitted to the logs, the error contains a sentence and the
/// plausibility warnings about the logs.
[[nodiscard]] tl::expected<IdentifiedLogs, std::string> identify_logs(IdentifyQuestion question);

/// Predicts the logs with a model. Outliers are removed from `logs` first. For each log with outliers, the
/// result contains a warning.
[[nodiscard]] Validation validate_given_logs(const model::Model& model, std::vector<Log>& logs,
                                             const RecordOptions& options);

}  // namespace softgrip::sysid
