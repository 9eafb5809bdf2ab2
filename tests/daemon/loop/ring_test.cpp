#include "daemon/loop/ring.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>
#include <thread>

#include "tests/daemon/loop/torn_value.h"

namespace softgrip::daemon::ring_test {
namespace {

using testing::TornValue;

/// An incorrect ring that looks correct: it announces an item before it has copied the item completely.
class AnnouncedTooEarly {
 public:
  explicit AnnouncedTooEarly(std::size_t capacity) : items_(capacity) {}
  bool push(const TornValue& item) noexcept {
    const std::size_t tail = tail_.load();
    if (tail - head_.load() == items_.size()) return false;
    tail_.store(tail + 1);
    items_[tail % items_.size()] = item;
    return true;
  }
  bool pop(TornValue& item) noexcept {
    const std::size_t head = head_.load();
    if (head == tail_.load()) return false;
    item = items_[head % items_.size()];
    head_.store(head + 1);
    return true;
  }

 private:
  std::vector<TornValue> items_;
  std::atomic<std::size_t> head_{0};
  std::atomic<std::size_t> tail_{0};
};

/// Sends the items 1 to `count` through a queue. Returns the number of items that arrive incompletely copied
/// or out of order.
template <class Queue>
std::uint64_t wrong_items(Queue& queue, std::uint64_t count) {
  std::thread producer([&queue, count] {
    for (std::uint64_t n = 1; n <= count;) {
      if (queue.push(TornValue(n))) {
        ++n;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t wrong = 0;
  TornValue item;
  for (std::uint64_t n = 1; n <= count;) {
    if (!queue.pop(item)) {
      std::this_thread::yield();
      continue;
    }
    if (!item.whole() || item.number() != n) ++wrong;
    ++n;
  }
  producer.join();
  return wrong;
}

TEST(Ring, RoundsTheCapacityUpToAPowerOfTwo) {
  EXPECT_EQ(Ring<int>(100).capacity(), 128U);
}

TEST(Ring, TakesABatchWholeOrNotAtAll) {
  Ring<int> ring(4);
  const std::array<int, 3> batch{1, 2, 3};
  EXPECT_TRUE(ring.push(batch));
  EXPECT_FALSE(ring.push(batch));
  EXPECT_EQ(ring.size(), 3U);
  EXPECT_TRUE(ring.push(4));
  EXPECT_FALSE(ring.push(5));
  std::array<int, 8> out{};
  EXPECT_EQ(ring.pop(out), 4U);
  EXPECT_EQ(out[0], 1);
  EXPECT_EQ(out[3], 4);
  EXPECT_EQ(ring.pop(out), 0U);
}

TEST(Ring, KeepsOrderOverManyWraps) {
  const unsigned seed = 20251120;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  Ring<int> ring(16);
  int next_in = 0;
  int next_out = 0;
  for (int round = 0; round < 10'000; ++round) {
    std::vector<int> batch(random() % 9);
    std::iota(batch.begin(), batch.end(), next_in);
    if (ring.push(batch)) next_in += static_cast<int>(batch.size());
    std::vector<int> out(random() % 9);
    const std::size_t count = ring.pop(out);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(out[i], next_out++);
    ASSERT_EQ(ring.size(), static_cast<std::size_t>(next_in - next_out));
  }
  EXPECT_GT(next_out, 10'000);
}

/// Tries to read an item from the queue while the producer is copying this item into the queue. Returns true
/// if the reader received an item.
template <class Queue>
bool taken_before_it_was_there(Queue& queue) {
  bool taken = false;
  const TornValue item(7);
  TornValue::halfway = [&] {
    TornValue seen;
    taken = queue.pop(seen);
  };
  queue.push(item);
  return taken;
}

TEST(Ring, AnItemIsReadableOnlyAfterACompleteCopy) {
  Ring<TornValue> ring(8);
  EXPECT_FALSE(taken_before_it_was_there(ring));
  TornValue item;
  EXPECT_TRUE(ring.pop(item));
  EXPECT_TRUE(item.whole());
  EXPECT_EQ(item.number(), 7U);
}

TEST(Ring, TheInterruptionTestDetectsAnIncorrectRing) {
  AnnouncedTooEarly ring(8);
  EXPECT_TRUE(taken_before_it_was_there(ring));
}

TEST(Ring, ASlotIsFreeOnlyAfterTheItemIsCopied) {
  Ring<TornValue> ring(2);
  ring.push(TornValue(1));
  ring.push(TornValue(2));
  bool pushed = true;
  TornValue::halfway = [&] { pushed = ring.push(TornValue(3)); };
  TornValue item;
  ASSERT_TRUE(ring.pop(item));
  EXPECT_FALSE(pushed);
  EXPECT_TRUE(item.whole());
  EXPECT_EQ(item.number(), 1U);
}

TEST(Ring, ConcurrentUseLosesAndTearsNoItem) {
  Ring<TornValue> ring(8);
  EXPECT_EQ(wrong_items(ring, testing::thread_sanitizer ? 2000 : 50'000), 0U);
}

}  // namespace
}  // namespace softgrip::daemon::ring_test
