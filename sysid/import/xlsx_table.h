#pragma once
// Spreadsheet workbooks (.xlsx): the values of one sheet.

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads the sheet that `options.sheet` names, else the only one with rows of numbers; several of them are a
/// problem that lists them. The cells are read like those of a text (text_table.h), so a workbook gives what
/// CSV with the same cells gives; the line of a row is its number in the sheet. Errors, formulas without a
/// stored value, merged cells and other sheets are named. `file` names the workbook in messages.
[[nodiscard]] std::optional<ForeignTable> read_xlsx_table(const std::string& file, std::string_view bytes,
                                                          const TableOptions& options,
                                                          document::Problems& problems);

}  // namespace softgrip::sysid
