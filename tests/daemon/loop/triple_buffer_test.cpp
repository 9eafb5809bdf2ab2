#include "daemon/loop/triple_buffer.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/daemon/loop/torn_value.h"

namespace softgrip::daemon::triple_buffer_test {
namespace {

using testing::TornValue;

/// An incorrect buffer with two slots that looks correct. The reader reads the slot that the writer is not
/// filling. If the writer publishes twice while the reader copies a value, the writer overwrites the slot
/// that is being copied.
template <class T>
class TwoSlots {
 public:
  T& write_slot() noexcept { return slots_[1 - current_.load()]; }
  void publish() noexcept { current_.store(1 - current_.load()); }
  bool fetch() noexcept {
    held_ = current_.load();
    return true;
  }
  const T& value() const noexcept { return slots_[held_]; }

 private:
  std::array<T, 2> slots_{};
  std::atomic<std::size_t> current_{0};
  std::size_t held_ = 0;
};

struct Seen {
  std::uint64_t torn = 0;
  std::uint64_t backward = 0;
  std::uint64_t fetched = 0;
  std::uint64_t last = 0;
  std::uint64_t last_written = 0;
};

/// Writes 1, 2, … in one thread while another thread reads until the writer has finished. On a busy
/// processor, the reader may start late. The writer therefore writes `count` additional values after the
/// first reading.
template <class Cell>
Seen race(Cell& cell, std::uint64_t count) {
  std::atomic<bool> reader_began{false};
  std::atomic<bool> done{false};
  std::uint64_t written = 0;
  std::thread writer([&cell, &reader_began, &done, &written, count] {
    for (std::uint64_t raced = 0; raced < count; raced += reader_began.load() ? 1U : 0U) {
      cell.write_slot() = TornValue(++written);
      cell.publish();
    }
    done.store(true);
  });
  Seen seen;
  while (!done.load()) {
    if (!cell.fetch()) continue;
    const TornValue copy(cell.value());
    ++seen.fetched;
    reader_began.store(true);
    if (!copy.whole()) ++seen.torn;
    if (copy.number() < seen.last) ++seen.backward;
    seen.last = copy.number();
  }
  writer.join();
  seen.last_written = written;
  if (cell.fetch()) seen.last = cell.value().number();  // check that the reader receives the newest value
  return seen;
}

TEST(TripleBuffer, ReturnsNoNewValueBeforeTheFirstPublish) {
  TripleBuffer<int> cell(7);
  EXPECT_FALSE(cell.fetch());
  EXPECT_EQ(cell.value(), 7);
}

TEST(TripleBuffer, ReturnsTheNewestValueOnce) {
  TripleBuffer<int> cell;
  for (int n = 1; n <= 5; ++n) cell.publish(n);
  EXPECT_TRUE(cell.fetch());
  EXPECT_EQ(cell.value(), 5);
  EXPECT_FALSE(cell.fetch());
  EXPECT_EQ(cell.value(), 5);
  cell.publish(6);
  EXPECT_TRUE(cell.fetch());
  EXPECT_EQ(cell.value(), 6);
}

TEST(TripleBuffer, KeepsTheFetchedValueWhileTheWriterPublishes) {
  TripleBuffer<int> cell;
  cell.publish(1);
  ASSERT_TRUE(cell.fetch());
  const int& held = cell.value();
  for (int n = 2; n < 100; ++n) {
    cell.publish(n);
    EXPECT_EQ(held, 1);
  }
}

/// Publishes `publishes` values while the reader is in the middle of its copy. Returns true if all words of
/// the copy are equal.
template <class Cell>
bool whole_when_interrupted(int publishes) {
  Cell cell;
  cell.write_slot() = TornValue(1);
  cell.publish();
  cell.fetch();
  TornValue::halfway = [&cell, publishes] {
    for (int n = 0; n < publishes; ++n) {
      cell.write_slot() = TornValue(static_cast<std::uint64_t>(2 + n));
      cell.publish();
    }
  };
  const TornValue copy(cell.value());
  return copy.whole() && copy.number() == 1;
}

TEST(TripleBuffer, ACopyIsCompleteDespiteConcurrentPublishes) {
  for (int publishes = 0; publishes < 10; ++publishes) {
    EXPECT_TRUE(whole_when_interrupted<TripleBuffer<TornValue>>(publishes)) << publishes;
  }
}

TEST(TripleBuffer, TheInterruptionTestDetectsAnIncorrectBuffer) {
  EXPECT_TRUE(whole_when_interrupted<TwoSlots<TornValue>>(1))
      << "a data race is detected only if the writer publishes twice while the reader copies";
  EXPECT_FALSE(whole_when_interrupted<TwoSlots<TornValue>>(2));
}

TEST(TripleBuffer, ConcurrentReadsAreCompleteAndNeverGoBackward) {
  TripleBuffer<TornValue> cell;
  const std::uint64_t count = testing::thread_sanitizer ? 2000 : 50'000;
  const Seen seen = race(cell, count);
  EXPECT_GE(seen.last_written, count);
  EXPECT_EQ(seen.last, seen.last_written);
  EXPECT_EQ(seen.torn, 0U);
  EXPECT_EQ(seen.backward, 0U);
  EXPECT_GT(seen.fetched, 0U);
}

}  // namespace
}  // namespace softgrip::daemon::triple_buffer_test
