#pragma once
// Conversion of a table and a mapping into a log.

#include <optional>
#include <string>
#include <vector>

#include "document/problem.h"
#include "sysid/import/account.h"
#include "sysid/import/mapping.h"
#include "sysid/import/table.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

struct ImportedLog {
  Log log;
  std::vector<std::string> notes;     ///< samples that were left out, and the origin of the times
  std::vector<std::string> warnings;  ///< lost samples, and options without effect
  RowAccount account;
};

/// Returns a word of `missing` as a number, or nullopt if it is not a number.
[[nodiscard]] std::optional<double> missing_number(const std::string& word);

/// Returns the log, by the rules of samples.h. Each row of the table is in the log, or is counted in
/// `account` with the reason. A share of lost rows above refused_share is a problem; a share above
/// warned_share is a warning. Columns and options without effect are reported. A log that parse_log() would
/// refuse is a problem. All problems are added to `problems`; they name the options of `softgrip import`.
[[nodiscard]] std::optional<ImportedLog> convert(const ForeignTable& table, const Mapping& mapping,
                                                 document::Problems& problems);

}  // namespace softgrip::sysid
