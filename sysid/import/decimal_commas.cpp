#include "sysid/import/decimal_commas.h"

#include <algorithm>

#include "sysid/import/units.h"
#include "sysid/logs/csv_text.h"
#include "sysid/logs/sensor_codes.h"

namespace softgrip::sysid {

void DecimalCommas::add(const CellValue& cell, std::string_view text) {
  if (cell.kind == CellKind::missing) return;
  if (cell.grouped && grouped_.empty()) grouped_ = trimmed(unquoted(text));
  is_decimal_ = is_decimal_ || (cell.with_comma && !cell.grouped);
  differs_ = differs_ || (cell.kind == CellKind::text && cell.grouped);
  if (cell.kind != CellKind::number || cell.with_comma) return;
  differs_ = differs_ || cell.number != without_comma_.value_or(cell.number);
  without_comma_ = cell.number;
}

std::string DecimalCommas::ambiguous_cell(std::span<const double> values) const {
  if (grouped_.empty() || is_decimal_ || !(differs_ || without_comma_)) return {};
  return differs_ || std::ranges::count(sensor_codes(values), *without_comma_) == 0 ? grouped_
                                                                                    : std::string();
}

}  // namespace softgrip::sysid
