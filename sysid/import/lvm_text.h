#pragma once
// LabVIEW measurement files (.lvm) as plain tables of text.

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

[[nodiscard]] bool is_lvm(std::string_view text);

/// The table of an .lvm file within the bounds of table.h: its sections one behind the other, the separator
/// and the decimal mark of its header, the times counted from X0 and Delta_X where the file has no X column,
/// units from Y_Unit_Label. The column of comments is left out. A section whose columns differ from the first
/// is a problem.
[[nodiscard]] std::optional<ForeignTable> read_lvm(const std::string& file, std::string_view bytes,
                                                   const TableOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
