#pragma once
// Models isolated wrong readings, for example from a reflection, a dust particle in the beam or a corrupted
// message.

#include <cstdint>

#include "base/random.h"
#include "model/block.h"

namespace softgrip::model {

/// Shifts a random share of the readings by +`size` or -`size`; the sign is random. A step of zero duration
/// uses no random number.
template <class T>
class Outliers {
 public:
  static constexpr bool at_samples = false;
  static constexpr BlockInfo info = block_info("outliers", Station::sensor, Kind::reading, Inverse::ignored,
                                               "Outliers", "Single wrong readings between correct readings.",
                                               "z = y ± size with the given probability");
  static constexpr std::array parameters{
      parameter("probability", "", "fraction of the readings that are wrong", Typical{0.01}, Within{0.0, 1.0},
                Scale{0.01}, Neutral{0.0}),
      parameter("size_mm", "mm", "error of the wrong readings", Typical{2.0}, Within{0.0, 1000.0},
                Scale{1.0})};

  Outliers(std::span<const T> values, const Preparation& preparation)
      : probability_(value_of(values[0])), size_mm_(values[1]), seed_(preparation.seed) {}

  void reset(const T& input) {
    drawn_ = 0;
    sign_ = 0.0;
    output_ = input;
  }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T& duration_s, const Surroundings&) {
    if (value_of(duration_s) > 0.0) {
      const double draw = uniform_at(seed_, drawn_++);
      sign_ = draw >= probability_ ? 0.0 : draw < 0.5 * probability_ ? -1.0 : 1.0;
    }
    return output_ = displacement_mm + size_mm_ * sign_;
  }

 private:
  double probability_;
  T size_mm_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  double sign_ = 0.0;
  T output_{0.0};
};

}  // namespace softgrip::model
