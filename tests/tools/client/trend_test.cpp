#include "tools/client/daemon_text.h"

#include <gtest/gtest.h>

namespace softgrip::tools::trend_test {
namespace {

std::string joined(const std::vector<std::string>& glyphs) {
  std::string text;
  for (const std::string& glyph : glyphs) text += glyph;
  return text;
}

TEST(Trend, DrawsAColumnPerSecondScaledToTheVisibleRange) {
  Trend trend;
  for (int tenths = 0; tenths < 80; ++tenths) trend.add(100 + tenths / 10.0, static_cast<int>(tenths / 10));
  EXPECT_EQ(joined(trend.glyphs(20, 1, true)), "▁▂▃▄▅▆▇█");
  EXPECT_EQ(joined(trend.glyphs(20, 1, false)), "_.,-~=*#");
  EXPECT_EQ(joined(trend.glyphs(3, 1, true)), "▁▅█")
      << "the scale of the trend must be that of the newest values";
}

TEST(Trend, DrawsNoiseBelowTheSmallestRangeAsAFlatLine) {
  Trend trend;
  for (int second = 0; second < 5; ++second) trend.add(second, second % 2 == 0 ? 0.0 : 0.1);
  EXPECT_EQ(joined(trend.glyphs(20, 6, false)), "_____");
}

TEST(Trend, ASecondWithoutAValueIsAGap) {
  Trend trend;
  trend.add(1, 1);
  trend.add(2, std::nullopt);
  trend.add(5, 2);
  EXPECT_EQ(joined(trend.glyphs(20, 1, false)), "_   #");
  trend.add(1e6, 3);
  EXPECT_EQ(trend.glyphs(1000, 1, false).size(), Trend::seconds_kept);
}

TEST(Trend, RestartsIfTimeGoesBackwards) {
  Trend trend;
  trend.add(500, 1);
  trend.add(501, 2);
  trend.add(0.1, 3);
  EXPECT_EQ(trend.glyphs(20, 1, false).size(), 1U);
  EXPECT_TRUE(Trend().glyphs(20, 1, false).empty());
}

}  // namespace
}  // namespace softgrip::tools::trend_test
