#pragma once
// Reader of LabVIEW measurement files (.lvm), which are tables of text.

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

[[nodiscard]] bool is_lvm(std::string_view text);

/// Returns the table of an .lvm file within the bounds of table.h, with its sections one after the other. The
/// header gives the separator and the decimal mark; Y_Unit_Label gives the units. If the file has no X
/// column, the times follow from X0 and Delta_X. The column of comments is left out. A section whose columns
/// differ from those of the first is a problem.
[[nodiscard]] std::optional<ForeignTable> read_lvm(const std::string& file, std::string_view bytes,
                                                   const TableOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
