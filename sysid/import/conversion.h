#pragma once
// A table and a mapping, made into a log.

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
  std::vector<std::string> notes;     ///< what was left out and how times were counted
  std::vector<std::string> warnings;  ///< what was lost or has no effect
  RowAccount account;
};

/// The word of `missing` as a number; nothing if it is none.
[[nodiscard]] std::optional<double> missing_number(const std::string& word);

/// The log, by the rules of samples.h. Each row of the table is in it, or is counted with the reason in its
/// account; a share of lost rows above refused_share is a problem, one above warned_share a warning. Columns
/// and options without effect are named; what the log contract refuses is refused here too. All problems are
/// added to `problems`, in the words of `softgrip import`'s options.
[[nodiscard]] std::optional<ImportedLog> convert(const ForeignTable& table, const Mapping& mapping,
                                                 document::Problems& problems);

}  // namespace softgrip::sysid
