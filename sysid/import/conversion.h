#pragma once
// Converts the table of an external file into a log. A mapping assigns the columns of the table to the
// columns of the log.
// Reports the table columns and the import options that have no effect on the log.

#include <optional>
#include <string>
#include <vector>

#include "document/problem.h"
#include "sysid/import/account.h"
#include "sysid/import/mapping.h"
#include "sysid/import/role_sources.h"
#include "sysid/import/samples.h"
#include "sysid/import/table.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

struct ImportedLog {
  Log log;
  /// Notes about samples that were left out, and about the origin of the times.
  std::vector<std::string> notes;
  std::vector<std::string> warnings;  ///< warnings about lost samples and about options without effect
  RowAccount account;
};

/// Converts the table into a log by the rules of samples.h. Each row of the table is either in the log or
/// counted in `account` with a reason. A share of lost rows above refused_share is a problem; a share above
/// warned_share gives a warning. Columns and options without effect are reported. A log that parse_log()
/// would refuse is a problem too. The log contains the corrections of parse_log(), and its notes state them.
/// All problems are added to `problems`, and their texts name the options of `softgrip import`.
[[nodiscard]] std::optional<ImportedLog> convert(const ForeignTable& table, const Mapping& mapping,
                                                 document::Problems& problems);

/// Adds a note or a warning for each unused column and for each option without effect. It is a problem if an
/// unused column of numbers identifies the finger of each row, and the rows belong to several fingers.
void report_unused(const ForeignTable& table, const Mapping& mapping, const RoleSources& sources,
                   ImportRemarks& remarks, document::Problems& problems);

}  // namespace softgrip::sysid
