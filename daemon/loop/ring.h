#pragma once
// A bounded lock-free queue from one thread to another, for rows, events and requests.

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

namespace softgrip::daemon {

/// A queue for one producer and one consumer. Neither thread waits: push() fails if there is no space, and
/// pop() returns the items that are available. Memory is allocated by the constructor and by no other
/// function. T is a plain value.
template <class T>
class Ring {
 public:
  /// Creates a queue for at least `capacity` items. The number is rounded up to a power of two.
  explicit Ring(std::size_t capacity) : items_(std::bit_ceil(capacity)), mask_(items_.size() - 1) {}

  [[nodiscard]] std::size_t capacity() const noexcept { return items_.size(); }

  /// For the producer. Adds `count` items and returns true; fill(item, index) writes each item into its slot
  /// of the queue. If there is no space for all `count` items, adds none of them and returns false.
  template <class Fill>
  bool push(std::size_t count, Fill&& fill) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (count > capacity() - (tail - known_head_)) {
      known_head_ = head_.load(std::memory_order_acquire);
      if (count > capacity() - (tail - known_head_)) return false;
    }
    for (std::size_t i = 0; i < count; ++i) fill(items_[(tail + i) & mask_], i);
    tail_.store(tail + count, std::memory_order_release);
    return true;
  }
  bool push(std::span<const T> items) noexcept {
    return push(items.size(), [items](T& item, std::size_t i) { item = items[i]; });
  }
  bool push(const T& item) noexcept { return push(std::span<const T>(&item, 1)); }

  /// For the consumer. Moves up to items.size() items out of the queue and returns their number.
  std::size_t pop(std::span<T> items) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (known_tail_ - head < items.size()) known_tail_ = tail_.load(std::memory_order_acquire);
    const std::size_t count = std::min(items.size(), known_tail_ - head);
    for (std::size_t i = 0; i < count; ++i) items[i] = items_[(head + i) & mask_];
    head_.store(head + count, std::memory_order_release);
    return count;
  }
  bool pop(T& item) noexcept { return pop(std::span<T>(&item, 1)) == 1; }

  /// For producer and consumer. Returns the number of items in the queue, which may change at any time.
  [[nodiscard]] std::size_t size() const noexcept {
    const std::size_t head = head_.load(std::memory_order_acquire);
    return tail_.load(std::memory_order_acquire) - head;
  }

 private:
  static constexpr std::size_t cache_line = 64;

  std::vector<T> items_;
  std::size_t mask_;
  // The producer stores the position of the consumer that it last read, and the consumer stores the position
  // of the producer that it last read. Therefore, most calls do not access the cache line of the other
  // thread.
  alignas(cache_line) std::atomic<std::size_t> head_{0};  // number of items that the consumer has taken so
                                                          // far; written by the consumer
  std::size_t known_tail_ = 0;  // position of the producer when the consumer last read it
  alignas(cache_line) std::atomic<std::size_t> tail_{0};  // number of items that the producer has added so
                                                          // far; written by the producer
  std::size_t known_head_ = 0;  // position of the consumer when the producer last read it
};

}  // namespace softgrip::daemon
