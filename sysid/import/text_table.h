#pragma once
// Reads external tables in text: CSV with any separator, or columns separated by tabs or blanks.

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads UTF-8 or Latin-1, with or without a byte order mark, or UTF-16 with a byte order mark. Skips
/// comments, empty lines and the lines above the names. Recognises a row of units. Accepts decimal points or
/// decimal commas, but refuses a file that contains both. If the last line has too few cells, it is left out
/// and counted. It is a problem if another row has a wrong number of cells. `file` is the name of the text in
/// messages.
[[nodiscard]] std::optional<ForeignTable> parse_text_table(const std::string& file, std::string_view text,
                                                           const TableOptions& options,
                                                           document::Problems& problems);

}  // namespace softgrip::sysid
