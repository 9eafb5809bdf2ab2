#include "sysid/logs/unit_factors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

struct UnitFactor {
  double factor;
  const char* means;
};

constexpr std::array pressures{UnitFactor{6.894757, "psi and kPa"}, UnitFactor{100, "bar and kPa"},
                               UnitFactor{10, "mbar and kPa"},      UnitFactor{1000, "Pa and kPa"},
                               UnitFactor{14.50377, "psi and bar"}, UnitFactor{101.325, "atm and kPa"}};

// Ratios of the readings to the expected values, for each probable mistake in a unit. The motion of a finger
// is nearly proportional to the pressure. Therefore, if a wrong unit makes the pressure values too small, the
// readings seem too large.
constexpr std::array mistakes{
    UnitFactor{6.894757, "psi in a pressure column read as kPa"},
    UnitFactor{100, "bar in a pressure column read as kPa"},
    UnitFactor{1000,
               "micrometres in the displacement column read as mm, or MPa in a pressure column taken "
               "for kPa"},
    UnitFactor{10, "millimetres in the displacement column converted as if the values were in cm"},
    UnitFactor{25.4, "millimetres in the displacement column converted as if the values were in inch"},
    UnitFactor{1 / 10.0,
               "cm in the displacement column read as mm, or mbar in a pressure column read as "
               "kPa"},
    UnitFactor{1 / 25.4, "inch in the displacement column read as mm"},
    UnitFactor{1 / 6.894757, "kPa in a pressure column read as psi"},
    UnitFactor{1 / 100.0, "kPa in a pressure column read as bar"},
    UnitFactor{1 / 1000.0,
               "metres in the displacement column read as mm, or Pa in a pressure column taken "
               "for kPa"}};

constexpr std::array mistakes_of_angles{
    UnitFactor{model::deg_per_rad, "degrees in the angle column read as radians"},
    UnitFactor{1 / model::deg_per_rad, "radians in the angle column read as degrees"},
    UnitFactor{6.894757, "psi in a pressure column read as kPa"},
    UnitFactor{1 / 6.894757, "kPa in a pressure column read as psi"},
    UnitFactor{1000, "MPa in a pressure column read as kPa"},
    UnitFactor{1 / 10.0, "mbar in a pressure column read as kPa"},
    UnitFactor{1 / 1000.0, "Pa in a pressure column read as kPa"}};

double apart(double factor, double of) {
  return std::abs(std::log(std::abs(factor) / of));
}

}  // namespace

std::string pressure_units_apart(double factor) {
  constexpr double close = 0.1;
  for (const UnitFactor& pair : pressures) {
    if (apart(factor, pair.factor) < close || apart(factor, 1 / pair.factor) < close) return pair.means;
  }
  return {};
}

std::string mistaken_unit(double factor, model::OutputUnit unit) {
  // Relative tolerance of the factor. The tolerance is large for two reasons: the motion of a finger is not
  // exactly proportional to the pressure, and the model may have been fitted to another finger.
  constexpr double close = 0.25;
  const UnitFactor* nearest = nullptr;
  const std::span<const UnitFactor> known = unit == model::OutputUnit::deg
                                                ? std::span<const UnitFactor>(mistakes_of_angles)
                                                : std::span<const UnitFactor>(mistakes);
  for (const UnitFactor& mistake : known) {
    if (nearest == nullptr || apart(factor, mistake.factor) < apart(factor, nearest->factor))
      nearest = &mistake;
  }
  if (apart(factor, nearest->factor) > close) return {};
  return std::string(nearest->means) + " (a factor of " +
         significant(nearest->factor > 1 ? nearest->factor : 1 / nearest->factor) + ")";
}

std::optional<ColumnExtent> extent_of(const std::vector<double>& values) {
  std::optional<ColumnExtent> extent;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (!extent) extent = ColumnExtent{value, value};
    extent->lowest = std::min(extent->lowest, value);
    extent->highest = std::max(extent->highest, value);
  }
  return extent;
}

}  // namespace softgrip::sysid
