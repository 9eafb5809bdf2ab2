#pragma once
// Models creep that starts above a threshold pressure.

#include <cstddef>
#include <vector>

#include "model/block.h"
#include "model/exponential.h"
#include "model/weight_cache.h"

namespace softgrip::model {

/// Computes the displacement of Kelvin-Voigt branches that creep only above their threshold pressure (hinge):
/// tau x' = c max(p - hinge, 0) - x, with the displacement x, the pressure p, the compliance c and the time
/// constant tau. The solution is exact if the pressure is straight and does not pass a hinge within the
/// segment. In all other cases, the pressure above the hinge is approximated by a parabola with the exact
/// mean.
template <class T>
class PressureDependentCreep {
 public:
  static constexpr BlockInfo info =
      block_info("pressure_dependent_creep", Station::actuator, Kind::element, Inverse::implicit,
                 "Pressure-dependent creep", "Creep that starts above a threshold pressure.",
                 "y += x1 + x2 + ..., tau x' = c max(p - hinge, 0) - x in every branch");
  static constexpr std::array<ParameterSpec, 0> parameters{};
  static constexpr std::array repeated{
      parameter("hinge#_kpa", "kPa", "threshold pressure above which branch # creeps", Typical{20.0},
                Within{0.0, 1e4}, Scale{5.0}, Placed{}),
      parameter("compliance#_mm_per_kpa", "mm/kPa",
                "final creep displacement of branch #, per kPa above the threshold pressure", Typical{0.05},
                Within{0.0, 1e4}, Scale{0.05}, Neutral{0.0}),
      parameter("time_constant#_s", "s", "time constant of branch #", Typical{5.0}, Within{1e-3, 1e6},
                Scale{2.0}, Placed{})};
  static constexpr std::size_t max_parts = 24;

  PressureDependentCreep(std::span<const T> values, const Preparation& preparation)
      : weights_(values.size() / 3) {
    for (std::size_t i = 0; i + 2 < values.size(); i += 3)
      branches_.push_back({values[i], values[i + 1], values[i + 2], T(0.0)});
    if (preparation.sample_time_s > 0) (void)weights(T(preparation.sample_time_s));
  }

  void reset(const T& input) {
    pressure_ = input;
    output_ = T(0.0);
    for (Branch& branch : branches_) {
      branch.x = branch.compliance * above(input, branch.hinge);
      output_ += branch.x;
    }
  }
  [[nodiscard]] T output() const { return output_; }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    pressure_ = in.end;
    if (is_zero(in.duration_s)) return Segment<T>::straight(in.duration_s, begin, begin);
    const ExponentialWeights<T>* w = weights(in.duration_s);
    T end(0.0), mean(0.0);
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      Branch& branch = branches_[i];
      const Segment<T> part = above(in, branch.hinge);
      const T bend = part.bend();
      mean += w[i].mean(branch.x, part, bend);
      branch.x = w[i].end(branch.x, part, bend);
      end += branch.x;
    }
    output_ = end;
    return {in.duration_s, begin, end, mean};
  }

  template <class U>
  [[nodiscard]] U peek(const T& duration_s, const U& end_kpa, const Surroundings&) const {
    U sum(0.0);
    const ExponentialWeights<T>* kept = is_zero(duration_s) ? nullptr : weights_.find(duration_s);
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const Branch& branch = branches_[i];
      if (is_zero(duration_s)) {
        sum = sum + branch.x;
        continue;
      }
      const ExponentialWeights<T> w = kept != nullptr ? kept[i] : branch.weights(duration_s);
      const U from(above(pressure_, branch.hinge)), to = above(end_kpa, branch.hinge);
      const U bend = (mean_above(pressure_, end_kpa, branch.hinge) - (from + to) * 0.5) * 6.0;
      sum = sum + (branch.x - w.loss * branch.x) + w.end_begin * from + w.end_rise * (to - from) +
            w.end_bend * bend;
    }
    return sum;
  }

 private:
  struct Branch {
    T hinge, compliance, time_constant_s;
    T x;

    [[nodiscard]] ExponentialWeights<T> weights(const T& duration_s) const {
      return ExponentialWeights<T>::make(duration_s, T(1.0 / time_constant_s),
                                         T(compliance / time_constant_s));
    }
  };

  template <class U>
  static U above(const U& pressure, const T& hinge) {
    return value_of(pressure) >= value_of(hinge) ? U(pressure - hinge) : U(0.0);
  }
  /// Returns the mean over a segment of the pressure above the hinge, max(p - hinge, 0). The pressure changes
  /// linearly from `begin` to `end`.
  template <class U>
  static U mean_above(const T& begin, const U& end, const T& hinge) {
    const U first(above(begin, hinge)), last = above(end, hinge);
    const bool begins = value_of(begin) >= value_of(hinge), ends = value_of(end) >= value_of(hinge);
    if (begins == ends) return (first + last) * 0.5;
    // Over time, the pressure above the hinge is a triangle, because the pressure is below the hinge at one
    // end of the segment. The height of the triangle is the pressure above the hinge at the opposite end.
    const U height = begins ? first : last;
    return height * height * 0.5 / (begins ? U(begin - end) : U(end - begin));
  }
  static Segment<T> above(const Segment<T>& in, const T& hinge) {
    const bool stays_above = value_of(in.begin) >= value_of(hinge) && value_of(in.end) >= value_of(hinge);
    return {in.duration_s, above(in.begin, hinge), above(in.end, hinge),
            stays_above ? T(in.mean - hinge) : mean_above(in.begin, in.end, hinge)};
  }

  const ExponentialWeights<T>* weights(const T& duration_s) {
    return weights_.at(duration_s, [&](std::span<ExponentialWeights<T>> out) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = branches_[i].weights(duration_s);
    });
  }

  std::vector<Branch> branches_;
  T pressure_{0.0};
  T output_{0.0};
  WeightCache<T> weights_;
};

}  // namespace softgrip::model
