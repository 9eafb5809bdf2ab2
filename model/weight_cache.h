#pragma once
// Stores response weights for durations that occur repeatedly.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/dual.h"
#include "model/exponential.h"

namespace softgrip::model {

/// Assigns the durations that occurred most recently to a few slots, so that a caller can store a value for
/// each of them. Durations occur repeatedly: the nominal sample time, and the pieces into which a delay
/// divides the sample time.
template <class T>
class RecentDurations {
 public:
  static constexpr std::size_t slots = 4;

  struct Slot {
    std::size_t index = 0;
    bool is_new = false;  ///< true: the slot contained another duration, so its value must be computed
  };

  /// Returns the slot of a duration. A new duration gets the slot of the oldest one.
  Slot at(const T& duration_s) {
    if (const std::optional<std::size_t> index = find(duration_s)) return {*index, false};
    const std::size_t index = next_;
    next_ = (next_ + 1) % slots;
    if (used_ < slots) ++used_;
    durations_[index] = duration_s;
    return {index, true};
  }

  /// Returns the index of the slot of a duration; empty if the duration has no slot. Does not change the
  /// slots.
  [[nodiscard]] std::optional<std::size_t> find(const T& duration_s) const {
    for (std::size_t index = 0; index < used_; ++index) {
      if (same(durations_[index], duration_s)) return index;
    }
    return std::nullopt;
  }

 private:
  std::size_t used_ = 0;
  std::size_t next_ = 0;
  std::array<T, slots> durations_{};
};

/// Stores the weights of `branches` responses for each of the most recent durations. The weights for a new
/// duration replace those for the oldest stored duration.
template <class T>
class WeightCache {
 public:
  explicit WeightCache(std::size_t branches)
      : branches_(branches), weights_(branches * RecentDurations<T>::slots) {}

  /// Returns the weights for a duration. If the duration is not stored, `fill(span)` computes the weights of
  /// all branches.
  template <class Fill>
  const ExponentialWeights<T>* at(const T& duration_s, Fill&& fill) {
    const auto [slot, is_new] = durations_.at(duration_s);
    if (is_new) fill(std::span(weights_).subspan(slot * branches_, branches_));
    return &weights_[slot * branches_];
  }

  /// Returns the stored weights for a duration; nullptr if the duration is not stored. Does not store
  /// anything.
  [[nodiscard]] const ExponentialWeights<T>* find(const T& duration_s) const {
    const std::optional<std::size_t> slot = durations_.find(duration_s);
    return slot ? &weights_[*slot * branches_] : nullptr;
  }

 private:
  std::size_t branches_;
  RecentDurations<T> durations_;
  std::vector<ExponentialWeights<T>> weights_;
};

/// The time constant of a first-order lag, with its weights for the most recent durations.
template <class T>
class LagWeights {
 public:
  /// @param sample_time_s  duration whose weights are computed at once; 0 if the sample time is irregular.
  LagWeights(const T& time_constant_s, double sample_time_s) : time_constant_s_(time_constant_s), cache_(1) {
    if (sample_time_s > 0 && !passes()) (void)at(T(sample_time_s));
  }

  [[nodiscard]] const T& time_constant_s() const { return time_constant_s_; }
  /// Returns true if the output equals the input, because the time constant is 0.
  [[nodiscard]] bool passes() const { return value_of(time_constant_s_) <= 0.0; }
  const ExponentialWeights<T>& at(const T& duration_s) {
    return cache_.at(duration_s, [&](std::span<ExponentialWeights<T>> out) {
      const T rate = 1.0 / time_constant_s_;
      out[0] = ExponentialWeights<T>::make(duration_s, rate, rate);
    })[0];
  }

 private:
  T time_constant_s_;
  WeightCache<T> cache_;
};

}  // namespace softgrip::model
