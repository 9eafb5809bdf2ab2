#include "sysid/logs/unit_factors.h"

#include <array>
#include <cmath>
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
    UnitFactor{6.894757, "a pressure column in psi was read as kPa"},
    UnitFactor{100, "a pressure column in bar was read as kPa"},
    UnitFactor{1000,
               "the displacement column in micrometres was read as mm, or a pressure column in MPa was "
               "read as kPa"},
    UnitFactor{10, "the displacement column in mm was converted as if its unit were cm"},
    UnitFactor{25.4, "the displacement column in mm was converted as if its unit were inch"},
    UnitFactor{1 / 10.0,
               "the displacement column in cm was read as mm, or a pressure column in mbar was read as "
               "kPa"},
    UnitFactor{1 / 25.4, "the displacement column in inch was read as mm"},
    UnitFactor{1 / 6.894757, "a pressure column in kPa was read as psi"},
    UnitFactor{1 / 100.0, "a pressure column in kPa was read as bar"},
    UnitFactor{1 / 1000.0,
               "the displacement column in metres was read as mm, or a pressure column in Pa was read "
               "as kPa"}};

constexpr std::array mistakes_of_angles{
    UnitFactor{model::deg_per_rad, "the angle column in degrees was read as radians"},
    UnitFactor{1 / model::deg_per_rad, "the angle column in radians was read as degrees"},
    UnitFactor{6.894757, "a pressure column in psi was read as kPa"},
    UnitFactor{1 / 6.894757, "a pressure column in kPa was read as psi"},
    UnitFactor{1000, "a pressure column in MPa was read as kPa"},
    UnitFactor{1 / 10.0, "a pressure column in mbar was read as kPa"},
    UnitFactor{1 / 1000.0, "a pressure column in Pa was read as kPa"}};

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

}  // namespace softgrip::sysid
