#include "base/random.h"

#include <gtest/gtest.h>

namespace softgrip::random_test {
namespace {

TEST(Scattered, IsSplitMix64) {
  constexpr std::uint64_t step = 0x9e3779b97f4a7c15ULL;
  // The expected values are the first outputs of the generator SplitMix64 for the seed 0.
  EXPECT_EQ(scattered(0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(scattered(step), 0x6e789e6aa1b965f4ULL);
  EXPECT_EQ(scattered(2 * step), 0x06c45d188009454fULL);
}

}  // namespace
}  // namespace softgrip::random_test
