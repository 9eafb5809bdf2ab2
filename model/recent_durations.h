#pragma once
// Assigns the durations that occurred most recently to a few slots, so that a caller can store a value for
// each of them. Durations occur repeatedly: the nominal sample time, and the pieces into which a delay
// divides the sample time.

#include <array>
#include <cstddef>
#include <optional>

#include "model/number.h"

namespace softgrip::model {

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

}  // namespace softgrip::model
