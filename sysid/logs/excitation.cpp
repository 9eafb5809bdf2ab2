#include "sysid/logs/excitation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sysid/logs/turning_points.h"

namespace softgrip::sysid {
namespace {

constexpr double unloaded_share = 0.2;
constexpr double no_pressure_share = 0.02;
constexpr double long_enough_s = 3;
constexpr double same_amplitude_share = 0.05;
/// Two commands count as equal if their difference is below this value, because files have at most six
/// decimals.
constexpr double same_command_kpa = 1e-6;

std::vector<double> sizes_of(const Log& log) {
  std::vector<double> sizes = log.pressure_command_kpa;
  for (double& size : sizes) size = std::abs(size);
  return sizes;
}

double largest_size_kpa(const std::vector<Log>& logs) {
  double largest = 0;
  for (const Log& log : logs) {
    for (const double kpa : log.pressure_command_kpa) largest = std::max(largest, std::abs(kpa));
  }
  return largest;
}

/// Returns the magnitudes of the command at its turning points.
std::vector<double> turns_of(const std::vector<double>& sizes, double least_kpa) {
  std::vector<double> turns;
  if (sizes.empty()) return turns;
  for (const std::size_t i : turning_points(sizes, least_kpa)) turns.push_back(sizes[i]);
  return turns;
}

bool unloads(const std::vector<double>& sizes, double by_kpa) {
  const std::vector<double> turns = turns_of(sizes, by_kpa);
  return std::adjacent_find(turns.begin(), turns.end(),
                            [&](double size, double next) { return next < size - by_kpa; }) != turns.end();
}

void add_peaks(const std::vector<double>& sizes, double least_kpa, std::vector<double>& peaks) {
  const std::vector<double> turns = turns_of(sizes, least_kpa);
  for (std::size_t i = 1; i + 1 < turns.size(); ++i) {
    if (turns[i] > turns[i - 1] && turns[i] > turns[i + 1]) peaks.push_back(turns[i]);
  }
}

}  // namespace

std::vector<Excitation> missing_excitation(const std::vector<Log>& logs) {
  const double largest_kpa = largest_size_kpa(logs);
  bool unloaded = false;
  std::vector<double> peaks;
  for (const Log& log : logs) {
    const std::vector<double> sizes = sizes_of(log);
    unloaded = unloaded || unloads(sizes, unloaded_share * largest_kpa);
    add_peaks(sizes, same_amplitude_share * largest_kpa, peaks);
  }
  std::vector<Excitation> missing;
  if (!unloaded) missing.push_back(Excitation::unloading);
  if (!contains_rest(logs)) missing.push_back(Excitation::rest);
  if (!peaks.empty()) {
    const auto [low, high] = std::minmax_element(peaks.begin(), peaks.end());
    if (*high - *low < same_amplitude_share * largest_kpa) missing.push_back(Excitation::amplitudes);
  }
  return missing;
}

std::string without(Excitation missing) {
  switch (missing) {
    case Excitation::unloading:
      return "the logs contain no unloading (decrease of the pressure), so hysteresis cannot be determined";
    case Excitation::rest:
      return "the logs contain no rest longer than 3 s at zero pressure, so creep, softening and drift are "
             "hard to separate";
    case Excitation::amplitudes:
      return "the logs contain only one amplitude of the pressure, so effects that depend on the amplitude "
             "cannot be determined";
  }
  return {};
}

bool contains_rest(const std::vector<Log>& logs) {
  const double largest_kpa = largest_size_kpa(logs);
  for (const Log& log : logs) {
    const std::vector<double>& u = log.pressure_command_kpa;
    double still_s = 0;
    for (std::size_t i = 1; i < u.size(); ++i) {
      const bool still =
          std::abs(u[i]) < no_pressure_share * largest_kpa && std::abs(u[i] - u[i - 1]) < same_command_kpa;
      still_s = still ? still_s + log.time_s[i] - log.time_s[i - 1] : 0;
      if (still_s > long_enough_s) return true;
    }
  }
  return false;
}

}  // namespace softgrip::sysid
