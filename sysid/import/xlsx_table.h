#pragma once
// Reads the values of one sheet of a spreadsheet workbook (.xlsx).

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Hint of the problem that is reported if several sheets of a workbook have rows of numbers. Callers
/// recognise the problem by this hint.
inline constexpr std::string_view select_sheet_hint = "to select one sheet, use --sheet";

/// Reads the sheet that `options.sheet` names. If this option is empty, reads the only sheet with rows of
/// numbers. If several sheets have rows of numbers, a problem lists these sheets. The cells are read like the
/// cells of a text (text_table.h), so a workbook gives the same table as CSV with the same cells. The line
/// number of a row is its number in the sheet. Notes name errors, formulas without a stored value, merged
/// cells and other sheets. `file` is the name of the workbook in messages.
[[nodiscard]] std::optional<ForeignTable> read_xlsx_table(const std::string& file, std::string_view bytes,
                                                          const TableOptions& options,
                                                          document::Problems& problems);

}  // namespace softgrip::sysid
