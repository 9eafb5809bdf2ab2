#include "daemon/loop/broadcast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <thread>
#include <utility>

#include "tests/daemon/loop/torn_value.h"

namespace softgrip::daemon::broadcast_test {
namespace {

/// A value of several equal words. If another thread changes the value while it is copied, the words of the
/// copy differ.
struct Item {
  std::array<std::uint64_t, 6> words{};
  [[nodiscard]] bool whole() const {
    return std::all_of(words.begin(), words.end(), [this](std::uint64_t word) { return word == words[0]; });
  }
};
Item item(std::uint64_t number) {
  Item made;
  made.words.fill(number);
  return made;
}

TEST(Broadcast, EveryReaderReceivesAllItemsInOrder) {
  Broadcast<Item> events(8);
  Broadcast<Item>::Reader eager(events);
  Broadcast<Item>::Reader slow(events);
  Item taken;
  EXPECT_FALSE(eager.pop(taken));
  for (std::uint64_t n = 1; n <= 5; ++n) {
    events.push(item(n));
    ASSERT_TRUE(eager.pop(taken));
    EXPECT_EQ(taken.words[0], n);
    EXPECT_FALSE(eager.pop(taken));
  }
  for (std::uint64_t n = 1; n <= 5; ++n) {
    ASSERT_TRUE(slow.pop(taken));
    EXPECT_EQ(taken.words[0], n);
  }
  EXPECT_EQ(eager.lost() + slow.lost(), 0U);
}

TEST(Broadcast, OnlyASlowReaderLosesTheOldestItems) {
  Broadcast<Item> events(4);
  Broadcast<Item>::Reader eager(events);
  Broadcast<Item>::Reader slow(events);
  Item taken;
  for (std::uint64_t n = 1; n <= 10; ++n) {
    events.push(item(n));
    EXPECT_TRUE(eager.pop(taken));
  }
  ASSERT_TRUE(slow.pop(taken));
  EXPECT_EQ(taken.words[0], 7U);
  EXPECT_EQ(slow.lost(), 6U);
  EXPECT_EQ(eager.lost(), 0U);
}

/// Runs a function once, in the middle of the next copy. The function performs actions of another thread that
/// would disturb the copy most.
struct AtTheWorstMoment {
  static inline std::function<void()> action;
  static void halfway() noexcept {
    if (const auto once = std::exchange(action, nullptr)) once();
  }
};
using Interrupted = Broadcast<Item, AtTheWorstMoment>;

TEST(Broadcast, AnItemOverwrittenDuringTheCopyIsCountedAsLost) {
  Interrupted events(4);
  Interrupted::Reader reader(events);
  for (std::uint64_t n = 1; n <= 4; ++n) events.push(item(n));
  AtTheWorstMoment::action = [&] { events.push(item(5)); };
  Item taken;
  ASSERT_TRUE(reader.pop(taken));
  EXPECT_TRUE(taken.whole());
  EXPECT_EQ(taken.words[0], 2U);
  EXPECT_EQ(reader.lost(), 1U);
}

TEST(Broadcast, AnItemIsReadableOnlyAfterACompleteCopy) {
  Interrupted events(4);
  Interrupted::Reader reader(events);
  bool taken = true;
  Item seen;
  AtTheWorstMoment::action = [&] { taken = reader.pop(seen); };
  events.push(item(1));
  EXPECT_FALSE(taken);
  for (std::uint64_t n = 2; n <= 4; ++n) events.push(item(n));
  // The fifth item overwrites the first item before the reader has read the first item.
  AtTheWorstMoment::action = [&] { taken = reader.pop(seen); };
  events.push(item(5));
  EXPECT_TRUE(taken);
  EXPECT_TRUE(seen.whole());
  EXPECT_EQ(seen.words[0], 2U);
}

TEST(Broadcast, ConcurrentReadersReceiveOrCountEveryItem) {
  Broadcast<Item> events(4);
  const std::uint64_t count = testing::thread_sanitizer ? 20'000 : 500'000;
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> wrong{0};
  const auto read = [&] {
    Broadcast<Item>::Reader reader(events);
    std::uint64_t taken = 0;
    std::uint64_t last = 0;
    for (bool over = false; !over;) {
      over = done.load();
      for (Item next; reader.pop(next);) {
        if (!next.whole() || next.words[0] <= last) ++wrong;
        last = next.words[0];
        ++taken;
      }
    }
    if (taken + reader.lost() != count || last != count) ++wrong;
  };
  std::thread one(read);
  std::thread other(read);
  for (std::uint64_t n = 1; n <= count; ++n) events.push(item(n));
  done.store(true);
  one.join();
  other.join();
  EXPECT_EQ(wrong.load(), 0U);
}

}  // namespace
}  // namespace softgrip::daemon::broadcast_test
