#pragma once
// Recognises the dates of a workbook by the number format of their cells, and writes them as text.

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace softgrip::sysid {

/// Returns true if a number in this format is a date or a time of day. Such formats are "yyyy-mm-dd" and
/// "[h]:mm:ss.000".
[[nodiscard]] bool is_date_format(std::string_view code);
[[nodiscard]] bool is_date_format(std::size_t builtin);

/// Returns a date in ISO 8601, or a time of day if `with_day` is false. Dates are rounded to 10 us, because
/// Excel stores them with a resolution of about 0.6 us. Times of day are rounded to 1 us.
/// @param serial  days since `from`.
[[nodiscard]] std::string iso_date(double serial, std::chrono::sys_days from, bool with_day);

}  // namespace softgrip::sysid
