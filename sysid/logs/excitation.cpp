#include "sysid/logs/excitation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace softgrip::sysid {
namespace {

constexpr double unloaded_share = 0.2;
constexpr double no_pressure_share = 0.02;
constexpr double long_enough_s = 3;
constexpr double same_amplitude_share = 0.05;
/// Two commands count as equal if their difference is below this value, which is larger than the rounding
/// errors in files.
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

/// Neighbouring values that are replaced by their mean.
struct Pool {
  double sum = 0;
  double count = 0;
};

void make_rising(std::span<double> values, double sign) {
  std::vector<Pool> pools;
  for (const double v : values) {
    Pool pool{sign * v, 1};
    while (!pools.empty() && pools.back().sum * pool.count >= pool.sum * pools.back().count) {
      pool.sum += pools.back().sum;
      pool.count += pools.back().count;
      pools.pop_back();
    }
    pools.push_back(pool);
  }
  std::size_t i = 0;
  for (const Pool& pool : pools) {
    for (auto left = static_cast<std::size_t>(pool.count); left > 0; --left)
      values[i++] = sign * pool.sum / pool.count;
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

std::vector<std::size_t> turning_points(const std::vector<double>& values, double least) {
  std::vector<std::size_t> turns{0};
  std::size_t highest = 0, lowest = 0;
  // As long as the signal has not moved by more than `least` in one direction, both variables may_fall and
  // may_rise are true.
  bool may_fall = true, may_rise = true;
  const auto turn = [&](std::size_t at) {
    if (at > turns.back()) turns.push_back(at);
  };
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[highest]) highest = i;
    if (values[i] < values[lowest]) lowest = i;
    if (may_fall && values[highest] - values[i] > least) {
      turn(highest);
      lowest = i;
      may_fall = false;
      may_rise = true;
    } else if (may_rise && values[i] - values[lowest] > least) {
      turn(lowest);
      highest = i;
      may_rise = false;
      may_fall = true;
    }
  }
  turn(values.size() - 1);
  return turns;
}

std::vector<double> steady_between_turns(std::vector<double> values, double least) {
  const std::vector<std::size_t> turns = turning_points(values, least);
  for (std::size_t k = 1; k < turns.size(); ++k) {
    const std::size_t from = turns[k - 1], to = turns[k];
    make_rising(std::span(values).subspan(from, to - from + 1), values[to] < values[from] ? -1 : 1);
  }
  return values;
}

}  // namespace softgrip::sysid
