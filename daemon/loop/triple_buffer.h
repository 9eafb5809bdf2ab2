#pragma once
// Passes the newest value from one thread to another without a lock. Loop, bus and socket exchange values
// with this class.

#include <array>
#include <atomic>
#include <cstdint>

namespace softgrip::daemon {

/// A triple buffer for one writer and one reader. Neither thread waits, retries or reads an incomplete value.
/// Both threads work on the slots directly, so a large value is not copied. Values that the reader does not
/// fetch in time are lost. There are three slots: the writer fills the write slot, and the reader holds the
/// read slot. Each of them exchanges its slot with the middle slot.
template <class T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  /// Creates a buffer whose slots are copies of `value`. This value does not count as published.
  explicit TripleBuffer(const T& value) : slots_{{{value}, {value}, {value}}} {}

  /// Returns the slot that the writer must fill before publish(). The slot contains an older value, which is
  /// not always the last published one.
  [[nodiscard]] T& write_slot() noexcept { return slots_[write_].value; }

  /// Exchanges the write slot with the middle slot. After this call, write_slot() returns a different slot.
  void publish() noexcept {
    const std::uint8_t taken = middle_.exchange(write_ | fresh, std::memory_order_acq_rel);
    write_ = taken & index_mask;
  }

  /// Copies a value into the write slot and publishes it.
  void publish(const T& value) noexcept {
    write_slot() = value;
    publish();
  }

  /// Fetches the newest value and returns true. Returns false if no value was published since the last call
  /// of fetch().
  bool fetch() noexcept {
    // The flag is read before the exchange. If there is no new value, an exchange would replace the present
    // value by an older one.
    if ((middle_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    const std::uint8_t taken = middle_.exchange(read_, std::memory_order_acq_rel);
    read_ = taken & index_mask;
    return true;
  }

  /// Returns the value of the last successful fetch(). Before the first successful fetch(), returns the
  /// initial value.
  [[nodiscard]] const T& value() const noexcept { return slots_[read_].value; }

 private:
  static constexpr std::uint8_t index_mask = 3;
  static constexpr std::uint8_t fresh = 4;
  static constexpr std::size_t cache_line = 64;

  struct alignas(cache_line) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(cache_line) std::uint8_t write_ = 0;               // index of the write slot; used only by the
                                                             // writer
  alignas(cache_line) std::uint8_t read_ = 1;                // index of the read slot; used only by the
                                                             // reader
  alignas(cache_line) std::atomic<std::uint8_t> middle_{2};  // index of the middle slot; used by writer and
                                                             // reader
};

}  // namespace softgrip::daemon
