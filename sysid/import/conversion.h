#pragma once
// A table and a mapping, made into a log.

#include <optional>
#include <string>
#include <vector>

#include "document/problem.h"
#include "sysid/import/mapping.h"
#include "sysid/import/table.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

struct ImportedLog {
  Log log;
  std::vector<std::string> notes;  ///< what was left out and how times were counted
};

/// The log, by the rules of samples.h; what the log contract refuses is refused here too. All problems are
/// added to `problems`, in the words of `softgrip import`'s options.
[[nodiscard]] std::optional<ImportedLog> convert(const ForeignTable& table, const Mapping& mapping,
                                                 document::Problems& problems);

}  // namespace softgrip::sysid
