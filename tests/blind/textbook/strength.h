#pragma once
// The strength of an effect in a world, and the scaling of an effect to a requested strength.

#include <string>
#include <vector>

#include "world.h"

namespace textbook {

/// Computes the part of a displacement difference that changes of a few parameters of the finger cannot
/// explain. The difference is linear in these changes. Zero and gain are unbounded, and every other parameter
/// stays within its bounds.
class Recalibration {
 public:
  /// Starts with only zero and gain as parameters.
  explicit Recalibration(const std::vector<double>& displacement_mm);
  /// Adds a parameter. A change by one unit changes the displacement by `change_mm`, and the parameter may
  /// change by `low` to `high` units.
  void add(std::vector<double> change_mm, double low, double high);
  /// Returns the RMS [mm] of the unexplained part of `difference_mm`.
  double left_mm(const std::vector<double>& difference_mm) const;

 private:
  struct Direction {
    std::vector<double> unit;  // unit vector
    double low, high;
  };
  std::vector<Direction> directions_;
  std::vector<std::vector<double>> products_;  // scalar products of all directions
};

struct Scaled {
  Numbers numbers;
  double excess_mm = 0;
  bool reachable = true;  // true if the excess is within 15 % of the target
};

/// The strength of an effect is the part of its change of the displacement that a refitted model cannot
/// explain, as RMS over the campaign. In the refit, zero and gain are unbounded, and the parameters of the
/// finger (own_numbers) stay within the bounds of its make. The whole displacement change by a leak counts,
/// because the measured pressure shows a leak, although a leak changes the displacement like a smaller gain.
class Excess {
 public:
  Excess(const World& world, const std::vector<Log>& logs, std::uint64_t seed);
  double of_mm(const Effects& effects) const;
  /// Returns the effect with the smallest amplitude that gives `target_mm`, or with the nearest amplitude if
  /// none does.
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
