#pragma once
// Computes the strength of an effect in a world. Scales an effect to a requested strength.

#include <string>
#include <vector>

#include "world.h"

namespace textbook {

using worlds::Scaled;

/// Computes the part of a displacement change that a refit of the finger's parameters cannot explain. The
/// refit uses a model that is linear in these parameters. Zero and gain have no bounds; every other parameter
/// has bounds.
class Recalibration {
 public:
  /// Creates a refit with two free parameters: the zero and the gain of the displacement.
  explicit Recalibration(const std::vector<double>& displacement_mm);
  /// Adds a parameter to the refit. A change of the parameter by one unit changes the displacement by
  /// `change_mm`. The refit may change the parameter by at least `low` and at most `high` units.
  void add(std::vector<double> change_mm, double low, double high);
  /// Returns the RMS [mm] of the part of `difference_mm` that the refit cannot explain.
  double left_mm(const std::vector<double>& difference_mm) const;

 private:
  struct Direction {
    std::vector<double> unit;  // displacement change by this parameter, scaled so that the vector has the
                               // length 1
    double low, high;
  };
  std::vector<Direction> directions_;
  std::vector<std::vector<double>> products_;  // scalar products of all pairs of directions
};

/// Computes the strength of an effect. The strength is the part of the displacement change by the effect that
/// a refitted model cannot explain, as RMS [mm] over the campaign. In the refit, zero and gain have no
/// bounds, and the parameters of the finger (own_numbers) stay within the bounds of its make. For a leak, the
/// strength is the whole displacement change. A leak changes the displacement like a smaller gain, but the
/// measured pressure shows the leak.
class Excess {
 public:
  Excess(const World& world, const std::vector<Log>& logs, std::uint64_t seed);
  double of_mm(const Effects& effects) const;
  /// Returns the effect with the strength `target_mm` and the smallest possible amplitude. If no amplitude
  /// has this strength, returns the effect with the nearest strength. The result is reachable if its strength
  /// is within 15 % of the target.
  Scaled scaled(const std::string& id, double target_mm) const;

 private:
  Setting setting_;
  std::vector<Log> logs_;
  std::uint64_t seed_;
  Pressures plain_kpa_;
  std::vector<double> plain_mm_;
  Recalibration twin_;
};

}  // namespace textbook
