#pragma once
// Models creep that is slower than all Kelvin-Voigt branches of the model, with one additional branch.

#include "model/block.h"
#include "model/exponential.h"
#include "model/weight_cache.h"

namespace softgrip::model {

/// Adds the displacement x to the model: tau x' = gain p - x with the pressure p. The block is equivalent to
/// a Kelvin-Voigt branch with the stiffness 1/gain and the damping tau/gain. In contrast to such a branch,
/// the block is also defined for gain 0, and its parameters are separate from the parameters of kelvin_voigt.
template <class T>
class SlowCreep {
 public:
  static constexpr BlockInfo info =
      block_info("slow_creep", Station::actuator, Kind::element, Inverse::implicit, "Slow creep",
                 "Creep that is slower than the slowest creep branch of the model.", "tau x' = gain p - x");
  static constexpr std::array parameters{
      parameter("gain_mm_per_kpa", "mm/kPa", "final creep displacement per pressure", Typical{0.05},
                Within{-10.0, 10.0}, Scale{0.02}, Neutral{0.0}),
      parameter("time_constant_s", "s", "time constant of the creep", Typical{60.0}, Within{0.1, 1e6},
                Scale{30.0})};

  SlowCreep(std::span<const T> values, const Preparation& preparation)
      : gain_(values[0]), rate_(1.0 / values[1]), weights_(1) {
    if (preparation.sample_time_s > 0) (void)weights(T(preparation.sample_time_s));
  }

  void reset(const T& input) {
    pressure_ = input;
    creep_kpa_ = input;
    output_ = gain_ * creep_kpa_;
  }
  [[nodiscard]] T output() const { return output_; }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    pressure_ = in.end;
    if (is_zero(in.duration_s)) return {in.duration_s, begin, begin, begin};
    const ExponentialWeights<T>& w = weights(in.duration_s);
    const T bend = in.bend();
    const T mean = w.mean(creep_kpa_, in, bend);
    creep_kpa_ = w.end(creep_kpa_, in, bend);
    output_ = gain_ * creep_kpa_;
    return {in.duration_s, begin, output_, gain_ * mean};
  }

  template <class U>
  [[nodiscard]] U peek(const T& duration_s, const U& end_kpa, const Surroundings&) const {
    if (is_zero(duration_s)) return U(output_);
    const ExponentialWeights<T>* kept = weights_.find(duration_s);
    const ExponentialWeights<T> w =
        kept != nullptr ? *kept : ExponentialWeights<T>::make(duration_s, rate_, rate_);
    const T fixed = creep_kpa_ - w.loss * creep_kpa_ + w.end_begin * pressure_ - w.end_rise * pressure_;
    return gain_ * fixed + (gain_ * w.end_rise) * end_kpa;
  }

 private:
  const ExponentialWeights<T>& weights(const T& duration_s) {
    return weights_.at(duration_s, [&](std::span<ExponentialWeights<T>> out) {
      out[0] = ExponentialWeights<T>::make(duration_s, rate_, rate_);
    })[0];
  }

  T gain_;
  T rate_;  // 1 divided by the time constant tau
  T pressure_{0.0};
  T creep_kpa_{0.0};  // low-pass filtered pressure that drives the creep
  T output_{0.0};
  WeightCache<T> weights_;
};

}  // namespace softgrip::model
