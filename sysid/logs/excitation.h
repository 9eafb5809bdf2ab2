#pragma once
// Finds motions that are missing in the commands of logs. Some effects are visible only during one kind of
// motion. If no log contains this motion, a fit cannot determine the effect.
// Finds the turning points of a signal, and approximates the signal by a monotone curve between them.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Motions that the logs of a fit should contain.
enum class Excitation : std::uint8_t {
  unloading,  ///< a decrease of the pressure by more than 20 % of the largest pressure
  rest,       ///< constant command below 2 % of the largest pressure for more than 3 s
  /// Two peaks whose pressures differ by at least 5 % of the largest pressure. After each peak, the pressure
  /// must fall by more than 5 % of the largest pressure.
  amplitudes,
};

/// Returns the motions that no log contains, but returns `amplitudes` only if the logs contain a peak.
/// Pressures are compared by their magnitudes. If the commands are vacuum pressures, the lowest pressure
/// therefore counts as the largest.
[[nodiscard]] std::vector<Excitation> missing_excitation(const std::vector<Log>& logs);

/// Returns a sentence about a missing motion. The sentence names the effect that cannot be determined without
/// this motion.
[[nodiscard]] std::string without(Excitation missing);

[[nodiscard]] bool contains_rest(const std::vector<Log>& logs);

/// Returns the indices of three kinds of samples in ascending order: the first sample, each sample after
/// which the signal reverses by more than `least`, and the last sample. If an extreme value occurs several
/// times, its first sample is used. `values` must contain at least one value, and all values must be finite.
[[nodiscard]] std::vector<std::size_t> turning_points(const std::vector<double>& values, double least);

/// Returns the least-squares approximation of `values` that is monotone between consecutive turning points
/// (pool adjacent violators: Barlow, Bartholomew, Bremner and Brunk, Statistical Inference under Order
/// Restrictions, 1972). If the true signal is monotone between these points too, the approximation is at
/// least as close to the true signal as `values`, measured by the sum of squared errors.
[[nodiscard]] std::vector<double> steady_between_turns(std::vector<double> values, double least);

}  // namespace softgrip::sysid
