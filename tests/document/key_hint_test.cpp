#include "document/reader.h"

#include <gtest/gtest.h>

namespace softgrip::document::key_hint_test {
namespace {

TEST(UnitAtEnd, RecognisesOnlyUnitsOfTheProject) {
  EXPECT_EQ(unit_at_end("squeeze_kpa"), "kpa");
  EXPECT_EQ(unit_at_end("squeeze_speed_kpa_per_s"), "kpa_per_s");
  EXPECT_EQ(unit_at_end("speed_mm_per_s"), "mm_per_s");
  EXPECT_EQ(unit_at_end("frequency_hz"), "hz");
  EXPECT_EQ(unit_at_end("cycles"), "");
  EXPECT_EQ(unit_at_end("s"), "") << "\"s\" alone is a name and not a unit";
  EXPECT_EQ(unit_at_end("delay_ms"), "") << "ms is not a unit of the project";
  EXPECT_EQ(unit_at_end("per_s"), "s");
  EXPECT_EQ(unit_at_end("mm_per_s"), "s") << "a key requires a word before its unit";
  EXPECT_EQ(unit_at_end(""), "");
}

}  // namespace
}  // namespace softgrip::document::key_hint_test
