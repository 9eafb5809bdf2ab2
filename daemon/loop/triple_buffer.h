#pragma once
// Passes the newest value from one thread to another without a lock. Loop, bus and socket exchange values
// this way.

#include <array>
#include <atomic>
#include <cstdint>

namespace softgrip::daemon {

/// A triple buffer for one writer and one reader. Neither thread waits, retries or reads an incomplete value.
/// Both work in place, so a large value is not copied. Values that the reader did not fetch in time are lost.
/// There are three slots: the writer fills the write slot, the reader holds the read slot, and both exchange
/// their slot with the middle slot.
template <class T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  /// All slots start as copies of `value`, which does not count as published.
  explicit TripleBuffer(const T& value) : slots_{{{value}, {value}, {value}}} {}

  /// Returns the slot to fill before publish(). It contains an older value, not necessarily the last
  /// published one.
  [[nodiscard]] T& write_slot() noexcept { return slots_[write_].value; }

  /// Exchanges the write slot with the middle slot: write_slot() returns another slot after this call.
  void publish() noexcept {
    const std::uint8_t taken = middle_.exchange(write_ | fresh, std::memory_order_acq_rel);
    write_ = taken & index_mask;
  }

  /// Copies and publishes a value.
  void publish(const T& value) noexcept {
    write_slot() = value;
    publish();
  }

  /// Fetches the newest value and returns true. Returns false if this value was fetched before.
  bool fetch() noexcept {
    // The flag is read first, because an exchange without a new value would replace the present value by an
    // older one.
    if ((middle_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    const std::uint8_t taken = middle_.exchange(read_, std::memory_order_acq_rel);
    read_ = taken & index_mask;
    return true;
  }

  /// Returns the value of the last successful fetch(); before that the initial value.
  [[nodiscard]] const T& value() const noexcept { return slots_[read_].value; }

 private:
  static constexpr std::uint8_t index_mask = 3;
  static constexpr std::uint8_t fresh = 4;
  static constexpr std::size_t cache_line = 64;

  struct alignas(cache_line) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(cache_line) std::uint8_t write_ = 0;               // used by the writer only
  alignas(cache_line) std::uint8_t read_ = 1;                // used by the reader only
  alignas(cache_line) std::atomic<std::uint8_t> middle_{2};  // shared
};

}  // namespace softgrip::daemon
