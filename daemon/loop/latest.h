#pragma once
// The newest value, from one thread to another, without a lock: what crosses between loop, bus and socket.

#include <array>
#include <atomic>
#include <cstdint>

namespace softgrip::daemon {

/// A triple buffer. One thread writes, one thread reads; neither ever waits, retries or sees half a value,
/// and both work in place, so a large value is not copied. Values that the reader did not fetch in time are
/// lost. Three slots: one the writer fills, one the reader holds, and one that travels between them.
template <class T>
class Latest {
 public:
  Latest() = default;
  /// All slots start as copies of `value`; it does not count as published.
  explicit Latest(const T& value) : slots_{{{value}, {value}, {value}}} {}

  /// The slot to fill before publish(). Its content is some older value, not necessarily the last published.
  [[nodiscard]] T& draft() noexcept { return slots_[draft_].value; }

  /// Hands the draft over; draft() is another slot from now on.
  void publish() noexcept {
    const std::uint8_t taken = traveller_.exchange(draft_ | fresh, std::memory_order_acq_rel);
    draft_ = taken & index_mask;
  }

  /// Copies and publishes.
  void publish(const T& value) noexcept {
    draft() = value;
    publish();
  }

  /// Fetches the newest value if there is one that was not fetched yet; says whether there was.
  bool fetch() noexcept {
    // The flag is looked at first: an exchange would put an old value back into circulation as if it were
    // new.
    if ((traveller_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    const std::uint8_t taken = traveller_.exchange(held_, std::memory_order_acq_rel);
    held_ = taken & index_mask;
    return true;
  }

  /// The value of the last fetch() that returned true; before that the initial one.
  [[nodiscard]] const T& value() const noexcept { return slots_[held_].value; }

 private:
  static constexpr std::uint8_t index_mask = 3;
  static constexpr std::uint8_t fresh = 4;
  static constexpr std::size_t cache_line = 64;

  struct alignas(cache_line) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(cache_line) std::uint8_t draft_ = 0;                  // the writer's
  alignas(cache_line) std::uint8_t held_ = 1;                   // the reader's
  alignas(cache_line) std::atomic<std::uint8_t> traveller_{2};  // shared
};

}  // namespace softgrip::daemon
