#pragma once
// Reads LabVIEW measurement files (.lvm), which are tables of text.

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

[[nodiscard]] bool is_lvm(std::string_view text);

/// Returns the table of an .lvm file; the bounds of table.h apply. The rows of all sections are concatenated.
/// The header states the separator, the decimal mark and, as Y_Unit_Label, the units. If the file has no X
/// column, the times are computed from X0 and Delta_X. The column of comments is left out. It is a problem if
/// the columns of a section differ from the columns of the first section.
[[nodiscard]] std::optional<ForeignTable> read_lvm(const std::string& file, std::string_view bytes,
                                                   const TableOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
