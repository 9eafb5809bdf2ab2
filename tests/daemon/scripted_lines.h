#pragma once
// Digital lines whose levels a test sets and reads.

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "base/clock.h"
#include "drivers/gpio/gpio_lines.h"

namespace softgrip::daemon::testing {

/// The levels at the terminals of the digital lines. The panel owns and destroys the lines. The terminals
/// exist longer than the lines. Any thread may call the functions.
class Terminals {
 public:
  Terminals() = default;
  /// Terminals in virtual time: if there is no edge, wait() advances the clock and returns immediately.
  explicit Terminals(VirtualClock& clock) : virtual_clock_(&clock) {}

  /// Sets the logical level of an input. If the level changes and `with_edge` is true, also reports an edge.
  void set(drivers::GpioRole role, bool active, bool with_edge = true) {
    const std::scoped_lock lock(mutex_);
    bool& level = levels_[index(role)];
    if (level != active && with_edge) edges_.push_back({role, active, now()});
    level = active;
    changed_.notify_all();
  }
  /// Makes all later calls fail, as if the GPIO chip had been removed.
  void fail() {
    const std::scoped_lock lock(mutex_);
    failed_ = true;
    changed_.notify_all();
  }
  [[nodiscard]] bool level(drivers::GpioRole role) const {
    const std::scoped_lock lock(mutex_);
    return levels_[index(role)];
  }
  /// Returns the values that were written to an output, oldest first.
  [[nodiscard]] std::vector<bool> written(drivers::GpioRole role) const {
    const std::scoped_lock lock(mutex_);
    return written_[index(role)];
  }
  [[nodiscard]] std::unique_ptr<drivers::GpioLines> lines();

 private:
  class Lines;
  static std::size_t index(drivers::GpioRole role) { return static_cast<std::size_t>(role); }
  [[nodiscard]] Nanoseconds now() const {
    return virtual_clock_ != nullptr ? virtual_clock_->now() : monotonic_now();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  VirtualClock* virtual_clock_ = nullptr;
  std::array<bool, drivers::gpio_role_count> levels_{};
  std::array<std::vector<bool>, drivers::gpio_role_count> written_;
  std::deque<drivers::GpioEdge> edges_;
  bool failed_ = false;
};

class Terminals::Lines final : public drivers::GpioLines {
 public:
  explicit Lines(Terminals& terminals) : terminals_(terminals) {}

  std::optional<std::size_t> wait(Nanoseconds timeout, std::span<drivers::GpioEdge> edges) noexcept override {
    std::unique_lock lock(terminals_.mutex_);
    const auto is_due = [&] { return terminals_.failed_ || !terminals_.edges_.empty(); };
    if (terminals_.virtual_clock_ == nullptr) {
      terminals_.changed_.wait_for(lock, std::chrono::nanoseconds(timeout), is_due);
    } else if (!is_due()) {
      terminals_.virtual_clock_->advance(std::max<Nanoseconds>(timeout, 1'000));  // the call takes 1 us
    }
    if (terminals_.failed_) return std::nullopt;
    std::size_t count = 0;
    while (count < edges.size() && !terminals_.edges_.empty()) {
      edges[count++] = terminals_.edges_.front();
      terminals_.edges_.pop_front();
    }
    return count;
  }
  std::optional<bool> read(drivers::GpioRole role) noexcept override {
    const std::scoped_lock lock(terminals_.mutex_);
    if (terminals_.failed_) return std::nullopt;
    return terminals_.levels_[index(role)];
  }
  bool write(drivers::GpioRole role, bool active) noexcept override {
    const std::scoped_lock lock(terminals_.mutex_);
    terminals_.levels_[index(role)] = active;
    terminals_.written_[index(role)].push_back(active);
    return !terminals_.failed_;
  }
  [[nodiscard]] bool sees_edges() const noexcept override { return true; }

 private:
  Terminals& terminals_;
};

inline std::unique_ptr<drivers::GpioLines> Terminals::lines() {
  return std::make_unique<Lines>(*this);
}

}  // namespace softgrip::daemon::testing
