#include "sysid/logs/log_columns.h"

#include <algorithm>
#include <map>

namespace softgrip::sysid {

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

}  // namespace softgrip::sysid
