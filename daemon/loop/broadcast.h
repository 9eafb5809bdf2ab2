#pragma once
// Distributes small values, such as the events of the loop, from one thread to several threads without a
// lock.

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace softgrip::daemon {

/// Has no effect. Tests replace this class by a class that interrupts each copy in the middle.
struct NoInterruption {
  static void halfway() noexcept {}
};

/// Distributes items from one thread to any number of readers. The writer never waits: if the buffer is full,
/// a new item replaces the oldest one. Each reader has its own thread and reads at its own speed. A reader
/// that lags by more than the capacity loses items, which are counted. Such a reader does not delay any other
/// thread. The constructor is the only function that allocates memory. T is a plain value.
template <class T, class Interruption = NoInterruption>
class Broadcast {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Creates a buffer for at least `capacity` items. The number is rounded up to a power of two.
  explicit Broadcast(std::size_t capacity) : slots_(std::bit_ceil(capacity)) {}

  [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

  void push(const T& item) noexcept {
    Words words{};
    std::memcpy(words.data(), &item, sizeof(T));
    Slot& slot = slot_of(pushed_);
    slot.turn.store(writing, std::memory_order_relaxed);
    // The release stores keep the order of the writes: a reader that sees a new word of the slot also sees
    // that the slot is being written.
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (i == words.size() / 2) Interruption::halfway();
      slot.words[i].store(words[i], std::memory_order_release);
    }
    slot.turn.store(++pushed_, std::memory_order_release);
    newest_.store(pushed_, std::memory_order_release);
  }

  /// A reader of the broadcast. Its first call of pop() returns the oldest stored item.
  class Reader {
   public:
    explicit Reader(const Broadcast& from) noexcept : from_(&from) {}

    /// Returns true and stores the next item in `item`. Returns false if there is no new item.
    bool pop(T& item) noexcept {
      for (;;) {
        const std::uint64_t newest = from_->newest_.load(std::memory_order_acquire);
        if (taken_ == newest) return false;
        if (newest - taken_ > from_->capacity()) lose(newest - from_->capacity());
        const Slot& slot = from_->slot_of(taken_);
        Words words{};
        const std::uint64_t before = slot.turn.load(std::memory_order_acquire);
        for (std::size_t i = 0; i < words.size(); ++i) {
          if (i == words.size() / 2) Interruption::halfway();
          words[i] = slot.words[i].load(std::memory_order_acquire);
        }
        const bool whole = before == taken_ + 1 && slot.turn.load(std::memory_order_relaxed) == before;
        if (!whole) {
          lose(taken_ + 1);
          continue;
        }
        ++taken_;
        std::memcpy(static_cast<void*>(&item), words.data(), sizeof(T));
        return true;
      }
    }

    /// Returns the number of items that this reader has lost, because the writer replaced them before this
    /// reader read them.
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

   private:
    void lose(std::uint64_t until) noexcept {
      lost_ += until - taken_;
      taken_ = until;
    }

    const Broadcast* from_;
    std::uint64_t taken_ = 0;
    std::uint64_t lost_ = 0;
  };

 private:
  using Words = std::array<std::uint64_t, (sizeof(T) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t)>;
  static constexpr std::uint64_t writing = UINT64_MAX;

  struct Slot {
    std::atomic<std::uint64_t> turn{0};  ///< number of the item in this slot, counted from 1
    std::array<std::atomic<std::uint64_t>, std::tuple_size_v<Words>> words{};
  };
  [[nodiscard]] Slot& slot_of(std::uint64_t index) noexcept { return slots_[index & (slots_.size() - 1)]; }
  [[nodiscard]] const Slot& slot_of(std::uint64_t index) const noexcept {
    return slots_[index & (slots_.size() - 1)];
  }

  std::vector<Slot> slots_;
  std::uint64_t pushed_ = 0;  // number of items written so far; used only by the writer
  alignas(64) std::atomic<std::uint64_t> newest_{0};
};

}  // namespace softgrip::daemon
