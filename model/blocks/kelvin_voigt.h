#pragma once
// Models Kelvin-Voigt creep with any number of branches in series with a spring. The transfer function from
// the pressure p to the displacement VE is:
//   VE(s)/p(s) = 1/k0 + sum_i 1/(c_i s + k_i)

#include <cstddef>
#include <vector>

#include "model/block.h"
#include "model/exponential.h"
#include "model/weight_cache.h"

namespace softgrip::model {

/// Computes the displacement of the spring and the branches. The solution is exact for a piecewise parabolic
/// pressure and any duration. A branch with k_i = 0 is a pure dashpot, so its displacement has no limit under
/// a constant pressure.
template <class T>
class KelvinVoigt {
 public:
  static constexpr BlockInfo info = block_info(
      "kelvin_voigt", Station::actuator, Kind::element, Inverse::implicit, "Kelvin-Voigt creep",
      "Creep: a spring in series with branches, each of which is a spring and a dashpot in parallel.",
      "y += p/k0 + x1 + x2 + ..., c x' = p - k x in every branch");
  static constexpr std::array parameters{parameter("k0_kpa_per_mm", "kPa/mm",
                                                   "stiffness of the instantaneous spring", Typical{300.0},
                                                   Within{1e-3, 1e9}, Scale{50.0}, Neutral{1e9})};
  static constexpr std::array repeated{
      parameter("k#_kpa_per_mm", "kPa/mm", "stiffness of branch #", Typical{5.0}, Within{0.0, 1e9},
                Scale{2.0}, Neutral{1e9}),
      parameter("c#_kpa_s_per_mm", "kPa s/mm", "damping of branch #; the time constant of the branch is c/k",
                Typical{10.0}, Within{1e-9, 1e9}, Scale{5.0}, Neutral{1e9})};
  static constexpr std::size_t max_parts = 12;

  KelvinVoigt(std::span<const T> values, const Preparation& preparation)
      : compliance_(1.0 / values[0]), weights_((values.size() - 1) / 2) {
    for (std::size_t i = 1; i + 1 < values.size(); i += 2)
      branches_.push_back({values[i], values[i + 1], T(0.0)});
    if (preparation.sample_time_s > 0) (void)weights(T(preparation.sample_time_s));
  }

  void reset(const T& input) {
    for (Branch& branch : branches_) {
      branch.x = value_of(branch.k) > 0.0 ? T(input / branch.k) : T(0.0);
    }
    pressure_ = input;
    output_ = sum();
  }

  [[nodiscard]] T output() const { return output_; }
  /// Returns 1/k0, the compliance of the spring, which responds without delay [mm/kPa].
  [[nodiscard]] const T& instantaneous_mm_per_kpa() const { return compliance_; }
  /// Returns the number of branches.
  [[nodiscard]] std::size_t branches() const { return branches_.size(); }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    pressure_ = in.end;
    T end = compliance_ * in.end;
    if (is_zero(in.duration_s)) {
      for (const Branch& branch : branches_) end += branch.x;
      output_ = end;
      return Segment<T>::straight(in.duration_s, begin, end);
    }
    const ExponentialWeights<T>* w = weights(in.duration_s);
    const T bend = in.bend();
    T mean = compliance_ * in.mean;
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      T& x = branches_[i].x;
      mean += w[i].mean(x, in, bend);
      x = w[i].end(x, in, bend);
      end += x;
    }
    output_ = end;
    return {in.duration_s, begin, end, mean};
  }

  template <class U>
  [[nodiscard]] U peek(const T& duration_s, const U& end_kpa, const Surroundings&) const {
    T fixed(0.0);
    T slope = compliance_;
    const ExponentialWeights<T>* kept = is_zero(duration_s) ? nullptr : weights_.find(duration_s);
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const Branch& branch = branches_[i];
      fixed += branch.x;
      if (is_zero(duration_s)) continue;
      const ExponentialWeights<T> w = kept != nullptr ? kept[i] : branch.weights(duration_s);
      fixed += w.end_begin * pressure_ - w.loss * branch.x - w.end_rise * pressure_;
      slope += w.end_rise;
    }
    return fixed + slope * end_kpa;
  }

 private:
  struct Branch {
    T k, c;
    T x;  // present displacement of the branch [mm]

    [[nodiscard]] ExponentialWeights<T> weights(const T& duration_s) const {
      return ExponentialWeights<T>::make(duration_s, T(k / c), T(1.0 / c));
    }
  };

  [[nodiscard]] T sum() const {
    T result = compliance_ * pressure_;
    for (const Branch& branch : branches_) result += branch.x;
    return result;
  }

  const ExponentialWeights<T>* weights(const T& duration_s) {
    return weights_.at(duration_s, [&](std::span<ExponentialWeights<T>> out) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = branches_[i].weights(duration_s);
    });
  }

  T compliance_;
  T pressure_{0.0};
  T output_{0.0};
  std::vector<Branch> branches_;
  WeightCache<T> weights_;
};

}  // namespace softgrip::model
