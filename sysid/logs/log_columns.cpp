#include "sysid/logs/log_columns.h"

#include <algorithm>
#include <map>

namespace softgrip::sysid {
namespace {

constexpr int shown = 3;

}  // namespace

std::string_view column_name(const KnownColumn& known, const Log& log) {
  if (known.values != &Log::displacement_mm) return known.name;
  return std::find_if(reading_columns.begin(), reading_columns.end(),
                      [&](const ReadingColumn& column) { return column.unit == log.output_unit; })
      ->name;
}

std::string conversion(std::string_view unit) {
  static const std::map<std::string_view, std::string_view> conversions{
      {"ms", "divide by 1000"},        {"us", "divide by 1e6"},    {"ns", "divide by 1e9"},
      {"min", "multiply by 60"},       {"bar", "multiply by 100"}, {"mbar", "divide by 10"},
      {"psi", "multiply by 6.894757"}, {"pa", "divide by 1000"},   {"mpa", "multiply by 1000"},
      {"m", "multiply by 1000"},       {"um", "divide by 1000"},   {"cm", "multiply by 10"},
      {"in", "multiply by 25.4"},      {"k", "subtract 273.15"},   {"f", "(f - 32) / 1.8"}};
  const auto found = conversions.find(unit);
  return found == conversions.end() ? std::string() : ", " + std::string(found->second);
}

void LogReporter::add(const std::string& kind, document::Location at, std::string_view line,
                      std::string message, std::string hint) {
  if (int& count = counts_[kind]; ++count <= shown) {
    problems_.add({file_, at, std::string(line.substr(0, 200)), std::move(message), std::move(hint)});
  } else {
    last_[kind] = {at, std::string(line.substr(0, 200))};
  }
}

void LogReporter::finish() {
  for (const auto& [kind, last] : last_) {
    problems_.add({file_,
                   last.first,
                   last.second,
                   kind + ": " + std::to_string(counts_[kind] - shown) +
                       " more problems of this kind, of which this line contains the last problem",
                   {}});
  }
  last_.clear();
}

}  // namespace softgrip::sysid
