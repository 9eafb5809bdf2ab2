#pragma once
// A value whose copy can be interrupted in the middle. With this value, tests of lock-free buffers do not
// depend on the timing of threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <utility>

namespace softgrip::daemon::testing {

/// A value of several equal words. If another thread changes the value while it is copied, the words of the
/// copy differ.
class TornValue {
 public:
  /// Function to call once, in the middle of the next copy in this thread. In a test, this function performs
  /// actions of another thread that would disturb the copy most.
  static inline thread_local std::function<void()> halfway;

  TornValue() = default;
  explicit TornValue(std::uint64_t number) { words_.fill(number); }
  TornValue(const TornValue& other) : TornValue() { copy(other); }
  TornValue& operator=(const TornValue& other) {
    if (this != &other) copy(other);
    return *this;
  }

  [[nodiscard]] std::uint64_t number() const noexcept { return words_.front(); }
  [[nodiscard]] bool whole() const noexcept {
    for (const std::uint64_t word : words_) {
      if (word != words_.front()) return false;
    }
    return true;
  }

 private:
  void copy(const TornValue& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      words_[i] = other.words_[i];
      if (i != words_.size() / 2) continue;
      if (const auto interruption = std::exchange(halfway, nullptr)) {
        interruption();
      } else {
        std::this_thread::yield();
      }
    }
  }

  std::array<std::uint64_t, 8> words_{};
};

#if defined(__SANITIZE_THREAD__)
inline constexpr bool thread_sanitizer = true;
#else
inline constexpr bool thread_sanitizer = false;
#endif

}  // namespace softgrip::daemon::testing
