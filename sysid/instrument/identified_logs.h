#pragma once
// Identification and validation of given logs, complete: wrong readings are taken out first, and warnings
// about the data come before the numbers that they concern. `softgrip identify`, `softgrip validate` and the
// library call these functions.

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
  std::vector<Log> logs;                       ///< to fit; at least one
  std::vector<Log> validation;                 ///< to predict
  std::optional<model::Model> start;           ///< empty: the base structure, from the data's scale
  std::string start_file;                      ///< of `start`, for a warning
  std::size_t branches = 2;                    ///< creep branches of the base structure
  std::optional<StructureQuestion> structure;  ///< selects the structure; nothing of `start` is used then
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

  /// Valid as long as this. @param call  the command and its arguments; empty: by no command
  [[nodiscard]] IdentifyReport report(std::vector<std::string> call) const;
};

/// Returns an error sentence if the logs cannot be fitted. It contains the plausibility warnings of the logs.
[[nodiscard]] tl::expected<IdentifiedLogs, std::string> identify_logs(IdentifyQuestion question);

/// Predicts the logs. Takes wrong readings out of them, with a warning for each log that has some.
[[nodiscard]] Validation validate_given_logs(const model::Model& model, std::vector<Log>& logs,
                                             const RecordOptions& options);

}  // namespace softgrip::sysid
