#pragma once
// Stores response weights for durations that occur repeatedly.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/exponential.h"
#include "model/recent_durations.h"

namespace softgrip::model {

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

}  // namespace softgrip::model
