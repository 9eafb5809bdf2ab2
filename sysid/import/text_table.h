#pragma once
// A foreign table of text: CSV in any dialect, or columns between tabs and blanks.

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads UTF-8 or Latin-1, with a byte order mark or without, or UTF-16 with one. Comments, lines above the
/// names, a row of units and empty lines are passed over; decimal points and commas are found, but not both
/// in one file; a last line that is cut off is left out and said. Other rows of another width are problems.
/// `file` names it in messages.
[[nodiscard]] std::optional<ForeignTable> parse_text_table(const std::string& file, std::string_view text,
                                                           const TableOptions& options,
                                                           document::Problems& problems);

}  // namespace softgrip::sysid
