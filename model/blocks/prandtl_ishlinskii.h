#pragma once
// Hysteresis as a sum of play operators (Kuhnen, European Journal of Control 9, 2003, section 2).

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "model/block.h"
#include "model/play.h"

namespace softgrip::model {

/// y += w1 play_r1(p) + w2 play_r2(p) + ..., a play with threshold 0 being the elastic gain. Rate
/// independent. With weights that are not negative it rises with the pressure, and so has an inverse. A
/// finger that had been loaded before begins with operators that were dragged along then, and its first
/// loading is no steeper than later ones; y is 0 where that left it.
template <class T>
class PrandtlIshlinskii {
 public:
  static constexpr BlockInfo info =
      block_info("prandtl_ishlinskii", Station::actuator, Kind::element, Inverse::implicit,
                 "Prandtl-Ishlinskii hysteresis", "Rate-independent hysteresis as a sum of play operators.",
                 "y += w1 o1 + w2 o2 + ..., |p - o| <= r in every operator, o moves only when it must");
  static constexpr std::array parameters{
      parameter("trained_kpa", "kPa", "largest load before the start; 0: a finger that was never loaded",
                Typical{15.0}, Within{0.0, 1e4}, Scale{10.0}, Placed{}, IfLeftOut{0.0})};
  static constexpr std::array repeated{
      parameter("r#_kpa", "kPa", "threshold of operator #, above that of the one before; 0: elastic",
                Typical{2.0}, Within{0.0, 1e4}, Scale{2.0}, Placed{}),
      parameter("w#_mm_per_kpa", "mm/kPa", "weight of operator #", Typical{0.1}, Within{0.0, 1e4}, Scale{0.1},
                Neutral{0.0})};
  static constexpr std::size_t max_parts = 24;

  PrandtlIshlinskii(std::span<const T> values, const Preparation&) : trained_kpa_(values[0]) {
    for (std::size_t i = 1; i + 1 < values.size(); i += 2)
      operators_.push_back({Play<T>(values[i]), values[i + 1]});
  }

  static std::string_view objection(std::span<const double> values) {
    for (std::size_t i = 3; i < values.size(); i += 2) {
      if (values[i] <= values[i - 2]) return "the thresholds must rise from operator to operator";
    }
    return {};
  }

  void reset(const T& input) {
    untouched_ = output_ = T(0.0);
    for (Operator& each : operators_) {
      each.play.reset(trained_kpa_);
      each.play.settle(T(0.0));
      untouched_ += each.weight * each.play.output();
      each.play.settle(input);
      output_ += each.weight * each.play.output();
    }
    output_ -= untouched_;
  }
  [[nodiscard]] T output() const { return output_; }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    T end = -untouched_, mean = -untouched_;
    const bool lasts = !is_zero(in.duration_s);
    for (Operator& each : operators_) {
      each.play.step(in, [&](const Segment<T>& part) {
        if (lasts) mean += each.weight * part.mean * (part.duration_s / in.duration_s);
      });
      end += each.weight * each.play.output();
    }
    output_ = end;
    return {in.duration_s, begin, end, lasts ? mean : T((begin + end) * 0.5)};
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_kpa, const Surroundings&) const {
    U sum(0.0);
    for (const Operator& each : operators_) sum = sum + each.weight * each.play.peek(end_kpa);
    return sum - untouched_;
  }

 private:
  struct Operator {
    Play<T> play;
    T weight;
  };

  T trained_kpa_;
  std::vector<Operator> operators_;
  T untouched_{0.0};  ///< the sum at no pressure, as the finger's past left it
  T output_{0.0};
};

}  // namespace softgrip::model
