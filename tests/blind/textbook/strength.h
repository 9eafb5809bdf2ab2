#pragma once
// How strong an effect is in a world, and how large it must be to be of a wanted strength.

#include <string>
#include <vector>

#include "world.h"

namespace textbook {

/// What a linear change of a few own numbers takes away from a difference of displacements. A zero and a gain
/// may become anything; every other number stays within its bounds.
class Recalibration {
 public:
  /// Zero and gain alone.
  explicit Recalibration(const std::vector<double>& displacement_mm);
  /// `change_mm`: what one unit of a number changes; it may move by `low` .. `high` units.
  void add(std::vector<double> change_mm, double low, double high);
  /// RMS [mm] of what is left of `difference_mm`.
  double left_mm(const std::vector<double>& difference_mm) const;

 private:
  struct Direction {
    std::vector<double> unit;  // of length one
    double low, high;
  };
  std::vector<Direction> directions_;
  std::vector<std::vector<double>> products_;  // of every direction with every other
};

struct Scaled {
  Numbers numbers;
  double excess_mm = 0;
  bool reachable = true;  // the excess is within 15 % of what was wanted
};

/// An effect's strength is the RMS over the campaign of what it adds to the displacement and the recalibrated
/// twin does not take up: its zero and gain may become anything, its finger's own numbers (own_numbers) what
/// fingers of its make have. A leak counts whole: the measured pressure shows it, while displacements take it
/// for a gain.
class Excess {
 public:
  Excess(const World& world, const std::vector<Log>& logs, std::uint64_t seed);
  double of_mm(const Effects& effects) const;
  /// The smallest amplitude that gives `target_mm`; the one that comes nearest where none does.
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
