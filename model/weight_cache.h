#pragma once
// Stores response weights for durations that occur repeatedly: the nominal sample time, and the pieces into
// which a delay divides the sample time.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "model/exponential.h"
#include "model/number.h"

namespace softgrip::model {

/// Stores the weights of `branches` responses for each of the most recent durations. The weights for a new
/// duration replace those for the oldest stored duration.
template <class T>
class WeightCache {
 public:
  explicit WeightCache(std::size_t branches) : branches_(branches), weights_(branches * slots) {}

  /// Returns the weights for a duration. If the duration is not stored, `fill(span)` computes the weights of
  /// all branches.
  template <class Fill>
  const ExponentialWeights<T>* at(const T& duration_s, Fill&& fill) {
    for (std::size_t slot = 0; slot < used_; ++slot) {
      if (same(durations_[slot], duration_s)) return &weights_[slot * branches_];
    }
    const std::size_t slot = next_;
    next_ = (next_ + 1) % slots;
    if (used_ < slots) ++used_;
    durations_[slot] = duration_s;
    fill(std::span(weights_).subspan(slot * branches_, branches_));
    return &weights_[slot * branches_];
  }

  /// Returns the stored weights for a duration; nullptr if the duration is not stored. Does not store
  /// anything.
  [[nodiscard]] const ExponentialWeights<T>* find(const T& duration_s) const {
    for (std::size_t slot = 0; slot < used_; ++slot) {
      if (same(durations_[slot], duration_s)) return &weights_[slot * branches_];
    }
    return nullptr;
  }

 private:
  static constexpr std::size_t slots = 4;
  std::size_t branches_;
  std::size_t used_ = 0;
  std::size_t next_ = 0;
  std::array<T, slots> durations_{};
  std::vector<ExponentialWeights<T>> weights_;
};

}  // namespace softgrip::model
