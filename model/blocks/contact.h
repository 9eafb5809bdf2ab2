#pragma once
// Stiffer beyond a position: an object that is touched, a stop.

#include "model/block.h"
#include "model/static_map.h"

namespace softgrip::model {

/// y up to the position; beyond it the motion is divided by 1 + stiffening.
template <class T>
class Contact {
 public:
  static constexpr BlockInfo info{
      .id = "contact",
      .station = Station::load,
      .kind = Kind::displacement,
      .inverse = Inverse::implicit,
      .title = "Contact",
      .meaning = "Stiffer beyond a position: an object or a stop.",
      .equation = "z = y up to the position, beyond it position + (y - position)/(1 + stiffening)",
      .repeatable = true};
  static constexpr std::array parameters{
      ParameterSpec{.name = "position_mm",
                    .unit = "mm",
                    .default_value = 15.0,
                    .lower = -1000.0,
                    .upper = 1000.0,
                    .scale = 2.0,
                    .meaning = "displacement at which contact begins"},
      ParameterSpec{
          .name = "stiffening",
          .unit = "",
          .default_value = 1.0,
          .lower = 0.0,
          .upper = 1e6,
          .scale = 0.5,
          .meaning = "added stiffness relative to the free actuator; 1 halves the motion beyond the position",
          .neutral = 0.0}};

  Contact(std::span<const T> values, const Preparation&)
      : position_mm_(values[0]), beyond_(1.0 / (1.0 + values[1])) {}

  void reset(const T& input) { output_ = map(input); }
  [[nodiscard]] T output() const { return output_; }
  [[nodiscard]] const T& position_mm() const { return position_mm_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    const Segment<T> out = mapped(
        in, [this](const T& y) { return map(y); }, output_);
    output_ = out.end;
    next(out);
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_mm, const Surroundings&) const {
    return map(end_mm);
  }

 private:
  template <class U>
  [[nodiscard]] U map(const U& y) const {
    return value_of(y) > value_of(position_mm_) ? U(position_mm_ + (y - position_mm_) * beyond_) : y;
  }

  T position_mm_;
  T beyond_;
  T output_{0.0};
};

}  // namespace softgrip::model
