#pragma once
// Reader of external tables in text: CSV with any separator, or columns separated by tabs or blanks.

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads UTF-8 or Latin-1, with or without a byte order mark, or UTF-16 with one. Skips comments, lines above
/// the names and empty lines. Recognises a row of units. Detects decimal points or decimal commas; a file
/// that contains both is refused. If the last line is incomplete, it is left out and counted. Other rows with
/// a different number of cells are problems. `file` names the text in messages.
[[nodiscard]] std::optional<ForeignTable> parse_text_table(const std::string& file, std::string_view text,
                                                           const TableOptions& options,
                                                           document::Problems& problems);

}  // namespace softgrip::sysid
