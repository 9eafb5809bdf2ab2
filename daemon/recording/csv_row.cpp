#include "daemon/recording/csv_row.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/enum_table.h"

namespace softgrip::daemon {

namespace {

constexpr double decimals_scale = 1e6;
constexpr double largest_scaled = 9e18;  // largest absolute value, as a number of millionths, that fits into
                                         // 63 bits
constexpr std::string_view columns =
    "time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,temperature_c,reference_mm,"
    "feedforward_kpa,feedback_kpa,residual_mm,"
    "deficit_mm,"  // words-ok: a documented column
    "age_s,state,step,validity,result,saturated,slewing";
constexpr std::string_view pressure_column = "pressure_kpa,", temperature_column = "temperature_c,";
/// Largest total length of the texts in a row [bytes]. The numbers and the name of the channel do not count.
constexpr std::size_t longest_words = 128;

/// All pairs of digits, from "00" to "99".
constexpr std::array<char, 200> digit_pairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

/// Writes `fraction` with `digits` decimals and without trailing zeros. If `fraction` is 0, writes nothing.
template <int digits>
char* write_fraction(char* to, std::uint64_t fraction) noexcept {
  static_assert(digits % 2 == 0);
  if (fraction == 0) return to;
  *to = '.';
  for (int at = digits - 1; at > 0; at -= 2) {
    std::memcpy(to + at, &digit_pairs[2 * (fraction % 100)], 2);
    fraction /= 100;
  }
  char* end = to + 1 + digits;
  while (end[-1] == '0') --end;
  return end;
}

char* write_whole(char* to, std::uint64_t value) noexcept {
  return std::to_chars(to, to + longest_decimal, value).ptr;
}

char* write_text(char* to, std::string_view text) noexcept {
  std::memcpy(to, text.data(), text.size());
  return to + text.size();
}

}  // namespace

char* write_decimal(char* to, double value) noexcept {
  if (!std::isfinite(value)) return to;
  const double scaled = std::abs(value) * decimals_scale + 0.5;
  if (scaled >= largest_scaled) return std::to_chars(to, to + longest_decimal, value).ptr;
  const auto units = static_cast<std::uint64_t>(scaled);
  constexpr auto scale = static_cast<std::uint64_t>(decimals_scale);
  if (value < 0 && units > 0) *to++ = '-';
  return write_fraction<6>(write_whole(to, units / scale), units % scale);
}

char* write_seconds(char* to, Nanoseconds duration) noexcept {
  const auto magnitude = static_cast<std::uint64_t>(std::abs(duration));
  constexpr std::uint64_t scale = 1'000'000'000;
  if (duration < 0) *to++ = '-';
  return write_fraction<10>(write_whole(to, magnitude / scale), magnitude % scale * 10);
}

CsvRows::CsvRows(std::vector<std::string> channel_names, bool with_pressure, bool with_temperature)
    : channel_names_(std::move(channel_names)),
      with_pressure_(with_pressure),
      with_temperature_(with_temperature) {
  for (const std::string& name : channel_names_) longest_name_ = std::max(longest_name_, name.size());
}

std::string CsvRows::header() const {
  std::string text(columns);
  const auto omit_column = [&](std::string_view column) {
    text.erase(text.find("," + std::string(column)) + 1, column.size());
  };
  if (!with_pressure_) omit_column(pressure_column);
  if (!with_temperature_) omit_column(temperature_column);
  return text + '\n';
}

void CsvRows::append(std::string& text, const Record& record, Nanoseconds begin) const {
  const control::ChannelOutput& row = record.output;
  const std::size_t old_size = text.size();
  text.resize(old_size + 11 * longest_decimal + longest_name_ + longest_words);
  char* to = text.data() + old_size;
  const auto number = [&to](double value) {
    to = write_decimal(to, value);
    *to++ = ',';
  };
  const auto word = [&to](std::string_view value, char end) {
    to = write_text(to, value);
    *to++ = end;
  };

  to = write_seconds(to, record.at - begin);
  *to++ = ',';
  word(channel_names_[record.channel], ',');
  number(row.command_kpa);
  if (row.validity == model::Validity::valid) {
    number(row.displacement_mm);
  } else {
    *to++ = ',';
  }
  if (with_pressure_) number(row.pressure_kpa);
  if (with_temperature_) number(row.temperature_c);
  number(row.reference_mm);
  number(row.feedforward_kpa);
  number(row.feedback_kpa);
  number(row.residual_mm);
  number(row.shortfall_mm);
  number(row.age_s);
  word(control::name_of(record.state), ',');
  to = write_whole(to, row.step);
  *to++ = ',';
  word(name_of(row.validity), ',');
  word(control::name_of(row.result), ',');
  word(row.saturated ? "1" : "0", ',');
  word(row.slewing ? "1" : "0", '\n');
  text.resize(static_cast<std::size_t>(to - text.data()));
}

std::string_view name_of(model::Validity validity) noexcept {
  static constexpr auto names = enum_names<model::Validity>({{model::Validity::valid, "valid"},
                                                             {model::Validity::none_yet, "none_yet"},
                                                             {model::Validity::out_of_range, "out_of_range"},
                                                             {model::Validity::sensor_error, "sensor_error"},
                                                             {model::Validity::jumped, "jumped"},
                                                             {model::Validity::frozen, "frozen"},
                                                             {model::Validity::stale, "stale"}});
  return names[validity];
}

}  // namespace softgrip::daemon
