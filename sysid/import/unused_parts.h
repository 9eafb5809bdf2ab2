#pragma once
// Reports the columns of a table and the options of an import that have no effect on the log.

#include "document/problem.h"
#include "sysid/import/mapping.h"
#include "sysid/import/role_sources.h"
#include "sysid/import/samples.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Adds a note or a warning for each unused column and for each option without effect. It is a problem if an
/// unused column of numbers identifies the finger of each row, and the rows belong to several fingers.
void report_unused(const ForeignTable& table, const Mapping& mapping, const RoleSources& sources,
                   ImportRemarks& remarks, document::Problems& problems);

}  // namespace softgrip::sysid
