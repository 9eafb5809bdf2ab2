#pragma once
// Computes creep branches that have the same input signal. Two branches are computed at a time.

#include <cstddef>
#include <unordered_map>
#include <vector>

#include "model/exponential.h"
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

  explicit LadderWeights(const std::vector<double>& time_constants_s) {
    for (const double tau_s : time_constants_s) rates_hz_.push_back(1 / tau_s);
  }

  [[nodiscard]] std::size_t pairs() const noexcept { return (rates_hz_.size() + 1) / 2; }
  /// Returns the weights of all pairs of branches for a step of this duration. The pointer is valid until the
  /// next call.
  [[nodiscard]] const PairWeights* of(double duration_s) {
    if (duration_s != last_s_) find(duration_s);
    return &stored_[at_];
  }

 private:
  /// Largest number of durations that are stored. Their weights need about 5 MB.
  static constexpr std::size_t most_durations = 16'384;

  void find(double duration_s) {
    if (index_.size() >= most_durations) {
      index_.clear();
      stored_.clear();
    }
    const auto [place, is_new] = index_.try_emplace(duration_s, stored_.size());
    last_s_ = duration_s;
    at_ = place->second;
    if (!is_new) return;
    stored_.resize(stored_.size() + pairs());
    for (std::size_t i = 0; i < rates_hz_.size(); ++i) {
      const auto w = model::ExponentialWeights<double>::make(duration_s, rates_hz_[i], rates_hz_[i]);
      PairWeights& pair = stored_[at_ + i / 2];
      pair.loss[i % 2] = w.loss;
      pair.begin[i % 2] = w.end_begin;
      pair.rise[i % 2] = w.end_rise;
      pair.bend[i % 2] = w.end_bend;
    }
  }

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
