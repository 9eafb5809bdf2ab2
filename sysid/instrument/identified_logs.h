#pragma once
// Complete identification and validation of given logs: wrong readings are removed first, and warnings about
// the data precede the values that they concern. `softgrip identify`, `softgrip validate` and the library
// call these functions.

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
  std::vector<Log> logs;                       ///< logs to fit; at least one
  std::vector<Log> validation;                 ///< logs to predict
  std::optional<model::Model> start;           ///< empty: the base structure, scaled to the data
  std::string start_file;                      ///< file of `start`, for a warning
  std::size_t branches = 2;                    ///< creep branches of the base structure
  std::optional<StructureQuestion> structure;  ///< if set, the structure is chosen and `start` is not used
  IdentifyOptions options;
};

/// An identification with the logs as they were used.
struct IdentifiedLogs {
  std::vector<Log> logs;
  std::vector<Log> validation_logs;
  model::Model start;
  Identification result;
  std::vector<Record> validation_records;
  std::vector<Score> validation;
  std::uint64_t seed = 1;

  /// Returns a report that is valid as long as this object. @param call  the command and its arguments; may
  /// be empty
  [[nodiscard]] IdentifyReport report(std::vector<std::string> call) const;
};

/// Identifies a model. If the logs cannot be fitted, the error is a sentence with their plausibility
/// warnings.
[[nodiscard]] tl::expected<IdentifiedLogs, std::string> identify_logs(IdentifyQuestion question);

/// Predicts the logs. Wrong readings are removed from `logs`, with a warning for each log that has some.
[[nodiscard]] Validation validate_given_logs(const model::Model& model, std::vector<Log>& logs,
                                             const RecordOptions& options);

}  // namespace softgrip::sysid
