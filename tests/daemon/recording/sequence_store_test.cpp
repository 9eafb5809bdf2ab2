#include "daemon/recording/sequence_store.h"

#include <gtest/gtest.h>

namespace softgrip::daemon::sequence_store_test {
namespace {

using Reader = SequenceStore::Reader;

void put(SequenceStore& store, std::uint32_t request) {
  store.put(request, std::make_shared<LoadedSequence>());
}
bool has(const SequenceStore& store, std::uint32_t request) {
  return store.find(request) != nullptr;
}

TEST(SequenceStore, ASequenceIsStoredUntilBothReadersHaveTakenALaterStart) {
  for (const auto& [first, second] :
       {std::pair(Reader::service, Reader::recorder), std::pair(Reader::recorder, Reader::service)}) {
    SequenceStore store;
    SCOPED_TRACE(first == Reader::service ? "the service is first" : "the recorder is first");
    put(store, 3);
    put(store, 5);
    put(store, 8);
    store.start_taken(first, 5);
    EXPECT_TRUE(has(store, 3));
    store.start_taken(second, 3);
    EXPECT_TRUE(has(store, 3));
    store.start_taken(second, 5);
    EXPECT_FALSE(has(store, 3));
    EXPECT_TRUE(has(store, 5)) << "this sequence may still run";
    EXPECT_TRUE(has(store, 8)) << "the start of this sequence waits for the loop";
  }
}

TEST(SequenceStore, ARecorderThatTakesNoStartDoesNotMakeTheStoreGrow) {
  SequenceStore store;
  constexpr std::uint32_t starts = 1000;
  for (std::uint32_t request = 1; request <= starts; ++request) {
    put(store, request);
    store.start_taken(Reader::service, request);
  }
  std::size_t stored = 0;
  for (std::uint32_t request = 1; request <= starts; ++request) stored += has(store, request) ? 1U : 0U;
  EXPECT_EQ(stored, SequenceStore::most_ended + 1);
  EXPECT_TRUE(has(store, starts));
}

TEST(SequenceStore, ARefusedStartIsRemovedAtOnce) {
  SequenceStore store;
  put(store, 3);
  put(store, 5);
  store.drop(5);
  EXPECT_TRUE(has(store, 3));
  EXPECT_FALSE(has(store, 5));
}

}  // namespace
}  // namespace softgrip::daemon::sequence_store_test
