#include "base/parallel.h"

#include <chrono>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "base/thread_budget.h"

// GCC 12 incorrectly warns that a new std::stop_source is not initialised.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

namespace softgrip::parallel_test {
namespace {

using namespace std::chrono_literals;

/// Stores the largest number of threads that have been inside visit() at the same time.
class Crowd {
 public:
  void visit() {
    const int now = ++inside_;
    for (int most = most_; now > most && !most_.compare_exchange_weak(most, now);) {
    }
    std::this_thread::sleep_for(1ms);
    --inside_;
  }
  [[nodiscard]] int most() const { return most_; }

 private:
  std::atomic<int> inside_{0}, most_{0};
};

TEST(ParallelFor, ProcessesEveryItemOnce) {
  for (const unsigned threads : {0U, 1U, 2U, 7U}) {
    std::vector<std::atomic<int>> done(100);
    parallel_for(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    for (const std::atomic<int>& times : done) ASSERT_EQ(times, 1);
  }
}

TEST(ParallelFor, UsesNoMoreThanTheGivenNumberOfThreads) {
  Crowd crowd;
  parallel_for(20, 3, [&](std::size_t) { crowd.visit(); });
  EXPECT_LE(crowd.most(), 3);
}

TEST(ParallelFor, StopsWithinAFewItemsAfterAStopRequest) {
  std::stop_source stop;
  const ThreadBudget budget(2, stop.get_token());
  std::atomic<int> begun{0};
  EXPECT_THROW(parallel_for(1000, 2,
                            [&](std::size_t) {
                              if (++begun == 5) stop.request_stop();
                            }),
               WorkCancelled);
  EXPECT_GE(begun, 5);
  EXPECT_LT(begun, 8);
  EXPECT_TRUE(is_cancelled());
  EXPECT_THROW(end_if_cancelled(), WorkCancelled);
}

TEST(ParallelFor, AThreadWithoutABudgetIsNeverCancelled) {
  EXPECT_FALSE(is_cancelled());
  EXPECT_NO_THROW(end_if_cancelled());
}

TEST(ParallelFor, NestedLoopsShareTheThreadsOfTheOuterLoop) {
  Crowd crowd;
  std::atomic<int> leaves{0};
  {
    const ThreadBudget budget(2);
    parallel_for(3, 4, [&](std::size_t) {
      parallel_for(5, 4, [&](std::size_t) {
        crowd.visit();
        ++leaves;
      });
    });
  }
  EXPECT_EQ(leaves, 15);
  // While a thread waits in the inner loop, a third thread may start in place of the waiting one. When the
  // wait ends, the waiting thread continues immediately, so three threads can run for a short time.
  EXPECT_LE(crowd.most(), 3);
}

/// Runs a parallel loop of two items. Returns true if the two items run at the same time.
bool side_by_side() {
  std::atomic<int> inside{0};
  std::atomic<bool> met{false};
  parallel_for_idle(2, [&](std::size_t) {
    ++inside;
    const auto until = std::chrono::steady_clock::now() + 50ms;
    while (!met && std::chrono::steady_clock::now() < until) {
      if (inside == 2) met = true;
    }
    --inside;
  });
  return met;
}

TEST(ParallelFor, ANestedLoopInTheLastItemUsesTheIdleThread) {
  for (const bool caller_works : {true, false}) {
    const ThreadBudget budget(2);
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<int> begun{0};
    bool found = false;
    parallel_for(2, 2, [&](std::size_t) {
      ++begun;
      while (begun < 2) std::this_thread::yield();
      if ((std::this_thread::get_id() == caller) != caller_works) return;
      const auto until = std::chrono::steady_clock::now() + 20s;
      while (!found && std::chrono::steady_clock::now() < until) found = side_by_side();
    });
    EXPECT_TRUE(found) << (caller_works ? "the calling thread worked while a helper thread was idle"
                                        : "a helper thread worked while the calling thread waited");
  }
}

TEST(ParallelForIdle, UsesOnlyTheCallingThreadWithoutABudget) {
  std::set<std::thread::id> threads;
  parallel_for_idle(50, [&](std::size_t) { threads.insert(std::this_thread::get_id()); });
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

TEST(ParallelFor, RethrowsAnExceptionAfterAllItemsAreDone) {
  const ThreadBudget budget(2);
  for (int round = 0; round < 50; ++round) {
    std::atomic<int> done{0};
    EXPECT_THROW(parallel_for(8, 2,
                              [&](std::size_t i) {
                                if (i == 3) throw std::runtime_error("no");
                                ++done;
                              }),
                 std::runtime_error);
    ASSERT_EQ(done, 7);
  }
  // The loop must have returned its helper thread to the thread budget. The test checks this by taking the
  // thread from the budget.
  EXPECT_EQ(ThreadBudget::current()->take(5), 1U);
  ThreadBudget::current()->give_back(1);
}

TEST(ThreadBudget, EndsWithTheScopeAndANestedBudgetHasNoEffect) {
  EXPECT_EQ(ThreadBudget::current(), nullptr);
  {
    const ThreadBudget outer(4);
    const ThreadBudget* const had = ThreadBudget::current();
    {
      const ThreadBudget inner(16);
      EXPECT_EQ(ThreadBudget::current(), had);
    }
    EXPECT_EQ(ThreadBudget::current(), had);
    EXPECT_EQ(ThreadBudget::current()->take(2), 2U);
    EXPECT_EQ(ThreadBudget::current()->take(5), 1U);
    EXPECT_EQ(ThreadBudget::current()->take(1), 0U);
    ThreadBudget::current()->give_back(3);
  }
  EXPECT_EQ(ThreadBudget::current(), nullptr);
}

}  // namespace
}  // namespace softgrip::parallel_test
