#include "sysid/import/workbook_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace softgrip::sysid {

bool is_date_format(std::size_t builtin) {
  return (builtin >= 14 && builtin <= 22) || (builtin >= 27 && builtin <= 36) ||
         (builtin >= 45 && builtin <= 47) || (builtin >= 50 && builtin <= 58);
}

bool is_date_format(std::string_view code) {
  for (std::size_t i = 0; i < code.size() && code[i] != ';'; ++i) {
    const char c = code[i];
    if (c == '\\' || c == '_' || c == '*') {
      ++i;  // the character after a backslash is literal
    } else if (c == '"') {
      i = std::min(code.find('"', i + 1), code.size());
    } else if (c == '[') {
      const std::size_t end = std::min(code.find(']', i), code.size());
      const std::string_view inside = code.substr(i + 1, end - i - 1);
      if (!inside.empty() && inside.find_first_not_of("hHmMsS") == std::string_view::npos) return true;
      i = end;
    } else if (std::string_view("yYmMdDhHsS").find(c) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

std::string iso_date(double serial, std::chrono::sys_days from, bool with_day) {
  constexpr std::int64_t ticks_a_second = 1'000'000;
  constexpr std::int64_t ticks_a_day = 86400 * ticks_a_second;
  const std::int64_t step = with_day ? 10 : 1;
  const auto ticks =
      static_cast<std::int64_t>(std::llround(serial * ticks_a_day / static_cast<double>(step))) * step;
  const std::chrono::year_month_day day{from + std::chrono::days{ticks / ticks_a_day}};
  const std::int64_t of_day = ticks % ticks_a_day;
  const std::int64_t second = of_day / ticks_a_second;
  std::array<char, 64> text{};
  if (with_day)
    std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d.%06d",
                  static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                  static_cast<unsigned>(day.day()), static_cast<int>(second / 3600),
                  static_cast<int>(second / 60 % 60), static_cast<int>(second % 60),
                  static_cast<int>(of_day % ticks_a_second));
  else
    std::snprintf(text.data(), text.size(), "%02d:%02d:%02d.%06d", static_cast<int>(second / 3600),
                  static_cast<int>(second / 60 % 60), static_cast<int>(second % 60),
                  static_cast<int>(of_day % ticks_a_second));
  return text.data();
}

}  // namespace softgrip::sysid
