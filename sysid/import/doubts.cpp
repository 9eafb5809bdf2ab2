#include "sysid/import/doubts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

// A soft finger moves at 20 to 60 kPa by some 10 mm; beyond these a unit was probably mistaken.
constexpr double small_pressure_kpa = 2;
constexpr double large_pressure_kpa = 1000;
constexpr double small_displacement_mm = 0.1;
constexpr double large_displacement_mm = 500;
constexpr double slow_sampling_s = 1;
constexpr double atmosphere_kpa = 101.325;
/// Correlations beyond this are no chance.
constexpr double clear_correlation = 0.5;

struct Sums {
  double count = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void add(double a, double b) {
    if (!std::isfinite(a) || !std::isfinite(b)) return;
    count += 1;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  [[nodiscard]] double variance_x() const { return count * xx - x * x; }
  [[nodiscard]] double covariance() const { return count * xy - x * y; }
  [[nodiscard]] double correlation() const {
    const double product = variance_x() * (count * yy - y * y);
    return product > 0 ? covariance() / std::sqrt(product) : 0;
  }
};

Sums sums_of(const std::vector<double>& x, const std::vector<double>& y) {
  Sums sums;
  for (std::size_t i = 0; i < x.size() && i < y.size(); ++i) sums.add(x[i], y[i]);
  return sums;
}

struct Extent {
  double lowest = 0, highest = 0;
  [[nodiscard]] double width() const { return highest - lowest; }
};
std::optional<Extent> extent_of(const std::vector<double>& values) {
  std::optional<Extent> extent;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (!extent) extent = Extent{value, value};
    extent->lowest = std::min(extent->lowest, value);
    extent->highest = std::max(extent->highest, value);
  }
  return extent;
}

/// A factor that lies between two units of pressure.
std::string units_apart(double factor) {
  struct Apart {
    double factor;
    const char* units;
  };
  constexpr std::array apart{Apart{6.894757, "psi and kPa"}, Apart{100, "bar and kPa"},
                             Apart{10, "mbar and kPa"},      Apart{1000, "Pa and kPa"},
                             Apart{14.50377, "psi and bar"}, Apart{101.325, "atm and kPa"}};
  for (const Apart& pair : apart) {
    if (std::abs(std::log(std::abs(factor) / pair.factor)) < 0.1 ||
        std::abs(std::log(std::abs(factor) * pair.factor)) < 0.1)
      return pair.units;
  }
  return {};
}

/// ForeignSamples by which the increments of `later` follow those of `earlier` best; negative: it comes
/// first.
int best_lag(const std::vector<double>& earlier, const std::vector<double>& later) {
  constexpr int farthest = 20;
  const auto increments = [](const std::vector<double>& values) {
    std::vector<double> steps(values.size(), 0);
    for (std::size_t i = 1; i < values.size(); ++i) steps[i] = values[i] - values[i - 1];
    return steps;
  };
  const std::vector<double> a = increments(earlier);
  const std::vector<double> b = increments(later);
  double best = 0;
  int lag = 0;
  for (int shift = -farthest; shift <= farthest; ++shift) {
    Sums sums;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto at = static_cast<std::ptrdiff_t>(i) + shift;
      if (at >= 0 && at < static_cast<std::ptrdiff_t>(b.size()))
        sums.add(a[i], b[static_cast<std::size_t>(at)]);
    }
    if (sums.correlation() <= best) continue;
    best = sums.correlation();
    lag = shift;
  }
  return best > clear_correlation ? lag : 0;
}

void doubt_measured_pressure(const Log& log, std::vector<std::string>& doubts) {
  if (log.pressure_kpa.empty() || log.pressure_kpa == log.pressure_command_kpa) return;
  const Sums sums = sums_of(log.pressure_command_kpa, log.pressure_kpa);
  if (sums.correlation() < -clear_correlation) {
    doubts.emplace_back("the measured pressure falls when the command rises: --scale pressure=-X turns it");
    return;
  }
  if (sums.correlation() < clear_correlation) return;
  const double slope = sums.covariance() / sums.variance_x();
  if (const std::string units = units_apart(slope); !units.empty())
    doubts.push_back("the measured pressure is " + significant(slope, 3) + " times the command, as " + units +
                     " are: is the unit of one of them another? --unit says it");
  constexpr int clearly_before = -2;
  if (best_lag(log.pressure_command_kpa, log.pressure_kpa) <= clearly_before)
    doubts.emplace_back("the measured pressure moves before its command: are the two columns swapped?");
}

void doubt_spans(const Log& log, std::vector<std::string>& doubts) {
  if (const auto p = extent_of(log.pressure_command_kpa); p && p->width() > 0) {
    if (p->highest < small_pressure_kpa)
      doubts.push_back("the pressure stays below " + significant(small_pressure_kpa) +
                       " kPa: bar or V in a column taken for kPa?");
    if (p->highest > large_pressure_kpa)
      doubts.push_back("the pressure reaches " + significant(p->highest) +
                       " kPa: no soft finger bears that; is the unit right?");
    if (p->lowest > 0.9 * atmosphere_kpa && p->lowest < 1.1 * atmosphere_kpa)
      doubts.push_back("the pressure never falls below " + significant(p->lowest) +
                       " kPa, about an atmosphere: absolute? --zero subtracts it");
  }
  if (const auto y = extent_of(log.displacement_mm); y && y->width() > 0) {
    if (y->width() < small_displacement_mm)
      doubts.push_back("the displacement spans " + significant(y->width()) +
                       " mm: metres or V in a column taken for mm?");
    if (y->width() > large_displacement_mm)
      doubts.push_back("the displacement spans " + significant(y->width()) +
                       " mm: micrometres in a column taken for mm?");
  }
  if (const auto t = extent_of(log.temperature_c); t && t->lowest > 200)
    doubts.emplace_back("the temperature is above 200 C: kelvin?");
}

}  // namespace

std::vector<std::string> doubts_about(const Log& log) {
  std::vector<std::string> doubts;
  const std::vector<double>& drive = log.pressure_kpa.empty() ? log.pressure_command_kpa : log.pressure_kpa;
  if (sums_of(drive, log.displacement_mm).correlation() < -clear_correlation)
    doubts.emplace_back(
        "the reading falls when the pressure rises: a sensor mounted the other way round? A negative "
        "--scale displacement=-X turns it");
  doubt_measured_pressure(log, doubts);
  doubt_spans(log, doubts);
  if (log.size() > 1) {
    const double interval = sampling_of(log).median_interval_s;
    if (interval > slow_sampling_s)
      doubts.push_back("samples are " + significant(interval) + " s apart: ms in a column taken for s?");
    if (interval < 1e-5)
      doubts.push_back("samples are " + significant(interval) + " s apart: is the unit of the time right?");
  }
  return doubts;
}

}  // namespace softgrip::sysid
