#pragma once
// Isolated wrong samples: a reflection, a dust particle in the beam, a disturbed telegram.

#include <cstdint>

#include "base/random.h"
#include "model/block.h"

namespace softgrip::model {

/// A share of the readings is off by `size`, up or down by chance. A step of zero duration does not draw.
template <class T>
class Outliers {
 public:
  static constexpr BlockInfo info{.id = "outliers",
                                  .station = Station::sensor,
                                  .kind = Kind::reading,
                                  .inverse = Inverse::ignored,
                                  .title = "Outliers",
                                  .meaning = "Isolated wrong samples.",
                                  .equation = "z = y +- size with the given probability"};
  static constexpr std::array parameters{ParameterSpec{.name = "probability",
                                                       .unit = "",
                                                       .default_value = 0.01,
                                                       .lower = 0.0,
                                                       .upper = 1.0,
                                                       .scale = 0.01,
                                                       .meaning = "share of the readings that are wrong",
                                                       .neutral = 0.0},
                                         ParameterSpec{.name = "size_mm",
                                                       .unit = "mm",
                                                       .default_value = 2.0,
                                                       .lower = 0.0,
                                                       .upper = 1000.0,
                                                       .scale = 1.0,
                                                       .meaning = "how wrong they are"}};

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
