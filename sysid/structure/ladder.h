#pragma once
// Computes creep branches that have the same input signal. Two branches are computed at a time.

#include <cstddef>
#include <unordered_map>
#include <vector>

#include "model/segment.h"

namespace softgrip::sysid {

/// Weights with which the states of creep branches at the end of a step are computed, for all step durations
/// that have occurred. A step lasts one sampling interval, or one of the parts into which a delay divides the
/// interval. In a log with an irregular sampling interval, each step has a duration of its own, and the steps
/// have the same durations in each evaluation with the same delay.
class LadderWeights {
 public:
  using Pair [[gnu::vector_size(16)]] = double;
  /// Weights for two branches; see model::ExponentialWeights.
  struct PairWeights {
    Pair loss{}, begin{}, rise{}, bend{};
  };

  explicit LadderWeights(const std::vector<double>& time_constants_s);

  [[nodiscard]] std::size_t pairs() const noexcept { return (rates_hz_.size() + 1) / 2; }
  /// Returns the weights of all pairs of branches for a step of this duration. The pointer is valid until the
  /// next call.
  [[nodiscard]] const PairWeights* of(double duration_s) {
    if (duration_s != last_s_) find(duration_s);
    return &stored_[at_];
  }

 private:
  void find(double duration_s);

  std::vector<double> rates_hz_;
  std::unordered_map<double, std::size_t> index_;  ///< for each duration, the index of its first pair
  std::vector<PairWeights> stored_;
  double last_s_ = -1;  ///< duration of the last call
  std::size_t at_ = 0;  ///< index for the duration of the last call
};

/// States of the branches.
class Ladder {
 public:
  /// @param weights  must outlive the object.
  /// @param at  input at which all branches are settled.
  Ladder(LadderWeights& weights, double at)
      : weights_(weights), x_(weights.pairs(), LadderWeights::Pair{at, at}) {}

  void step(const model::Segment<double>& in) {
    if (x_.empty() || in.duration_s <= 0) return;
    const LadderWeights::PairWeights* w = weights_.of(in.duration_s);
    const double begin = in.begin, rise = in.end - in.begin, bend = in.bend();
    for (LadderWeights::Pair& x : x_) {
      x = x - w->loss * x + w->begin * begin + w->rise * rise + w->bend * bend;
      ++w;
    }
  }
  [[nodiscard]] double value(std::size_t branch) const { return x_[branch / 2][branch % 2]; }

 private:
  LadderWeights& weights_;
  std::vector<LadderWeights::Pair> x_;
};

}  // namespace softgrip::sysid
