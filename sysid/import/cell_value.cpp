#include "sysid/import/cell_value.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/numbers.h"
#include "sysid/import/moments.h"
#include "sysid/import/units.h"
#include "sysid/logs/csv_text.h"
#include "sysid/logs/sensor_codes.h"

namespace softgrip::sysid {
namespace {

constexpr std::array<std::string_view, 14> missing_words{
    "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "-nan", "inf", "-inf", "+inf", "infinity", "."};
constexpr std::size_t longest_number = 64;

std::optional<double> number_of(std::string_view text, CellValue& value) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) {
    const auto number = to_number(text);
    value.with_point = number && text.find('.') != std::string_view::npos;
    return number;
  }
  const bool decimal = text.size() <= longest_number && text.find('.') == std::string_view::npos &&
                       text.find(',', comma + 1) == std::string_view::npos && comma + 1 < text.size() &&
                       std::isdigit(static_cast<unsigned char>(text[comma + 1])) != 0;
  if (!decimal) return std::nullopt;
  std::string pointed(text);
  pointed[comma] = '.';
  const auto number = to_number(pointed);
  value.with_comma = number.has_value();
  return number;
}

/// Returns true if the text is a whole number in groups of three digits, with commas or with points between
/// the groups.
bool has_groups_of_thousands(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  const char mark = text.find(',') == std::string_view::npos ? '.' : ',';
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[text.size() - 1 - i];
    if (i % 4 == 3 ? c != mark : std::isdigit(static_cast<unsigned char>(c)) == 0) return false;
  }
  return text.size() > 4 && text.size() % 4 != 0 && text.front() != '0';
}

/// Returns the index of the first word in the list `missing` that equals the cell; -1 if no word equals the
/// cell.
int place_among(const std::vector<std::string>& missing, std::string_view text,
                std::optional<double> number) {
  const auto found = std::find_if(missing.begin(), missing.end(), [&](const std::string& word) {
    const auto as_number = number ? to_number(word) : std::nullopt;
    return word == lower_case(text) || (as_number && *as_number == *number);
  });
  return found == missing.end() ? -1 : static_cast<int>(found - missing.begin());
}

bool says_missing(std::string_view text, const std::optional<double>& number) {
  if (text.empty()) return true;
  if (number) return !std::isfinite(*number);
  return std::find(missing_words.begin(), missing_words.end(), lower_case(text)) != missing_words.end();
}

}  // namespace

CellValue cell_value(std::string_view cell, const std::vector<std::string>& missing) {
  CellValue value;
  const std::string_view text = trimmed(unquoted(cell));
  const auto number = number_of(text, value);
  value.grouped = has_groups_of_thousands(text);
  if (!missing.empty()) value.missing_word = place_among(missing, text, number);
  if (value.missing_word >= 0 || says_missing(text, number)) {
    value.kind = CellKind::missing;
  } else if (number) {
    value.kind = CellKind::number;
    value.number = *number;
  } else if (const auto moment = moment_of(text)) {
    value.kind = CellKind::moment;
    value.moment = moment->time;
    value.dated = moment->dated;
    value.short_clock = moment->short_clock;
    value.surely_minutes = moment->surely_minutes;
  }
  return value;
}

std::optional<std::size_t> whole_number(std::string_view text) {
  std::size_t value = 0;
  const char* const all = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), all, value);
  if (error != std::errc{} || end != all) return std::nullopt;
  return value;
}

void DecimalMarks::add(const CellValue& cell, std::string_view text) {
  if (cell.kind == CellKind::missing) return;
  const bool has_mark = cell.with_comma || cell.with_point;
  if (cell.grouped && grouped_.empty()) grouped_ = trimmed(unquoted(text));
  is_decimal_ = is_decimal_ || (has_mark && !cell.grouped);
  differs_ = differs_ || (cell.kind == CellKind::text && cell.grouped);
  if (cell.kind != CellKind::number || has_mark) return;
  differs_ = differs_ || cell.number != without_mark_.value_or(cell.number);
  without_mark_ = cell.number;
}

std::string DecimalMarks::ambiguous_cell(std::span<const double> values) const {
  if (grouped_.empty() || is_decimal_ || !(differs_ || without_mark_)) return {};
  if (differs_) return grouped_;
  // Some programs write the value at rest as 0 and all other values with three decimals after a point.
  const bool is_point = grouped_.find('.') != std::string::npos;
  return is_point || std::ranges::count(sensor_codes(values), *without_mark_) > 0 ? std::string() : grouped_;
}

}  // namespace softgrip::sysid
