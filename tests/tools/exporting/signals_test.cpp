#include "tools/exporting/signals.h"

#include <string>

#include <gtest/gtest.h>

#include "base/files.h"

// This file checks the signals. tests/system/test_export.py checks the exported files with the programs that
// read them.
namespace softgrip::tools::signals_test {
namespace {

std::vector<SignalGroup> two_fingers() {
  return {
      {"left", {0, 0.01, 0.02}, {{"p_kpa", {1, std::nan(""), 3}, {}}, {"state", {}, {"idle", "a,b", ""}}}},
      {"right", {0.01, 0.03}, {{"p_kpa", {5, 6}, {}}}}};
}

TEST(Signals, WideTableMergesAllFingersOnOneTimeAxis) {
  EXPECT_EQ(wide_csv(wide(two_fingers())),
            "time_s,left_p_kpa,left_state,right_p_kpa\n"
            "0,1,idle,\n"
            "0.01,,\"a,b\",5\n"
            "0.02,3,,\n"
            "0.03,,,6\n");
}

TEST(Signals, SignalsWithoutAChannelKeepTheirNames) {
  const SignalGroup all = wide({{"", {0}, {{"measured_mm", {1}, {}}}}});
  EXPECT_EQ(all.signals.front().name, "measured_mm");
}

TEST(Signals, StoredCellsAreWrittenToTheTableUnchanged) {
  const Signal numbers{"gain", {1.5, std::nan("")}, {"1.50", ""}};
  const std::vector<SignalGroup> groups{{"", {0, 1}, {numbers}}};
  EXPECT_FALSE(numbers.is_text());
  EXPECT_EQ(wide_csv(wide(groups)), "time_s,gain\n0,1.50\n1,\n");
  EXPECT_NE(mcap_bytes(groups, "test").find("{\"time_s\":0,\"gain\":1.5}"), std::string::npos);
  const auto mat = mat_bytes(wide(groups));
  ASSERT_TRUE(mat) << mat.error();
  EXPECT_TRUE(mat->left_out.empty());
}

TEST(Signals, ATableWithNumbersThatMayBeRoundedGivesAWarning) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/series.csv";
  const auto warning = [&](const char* number) {
    EXPECT_TRUE(write_file(path, std::string("time_s,serial,x_mm\n0,") + number + ",1\n1,7,2\n"));
    ::testing::internal::CaptureStderr();
    EXPECT_TRUE(read_signals(path));
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(warning("9007199254740992"), "");
  const std::string text = warning("-12345678901234567");
  EXPECT_NE(text.find("'serial' may be rounded"), std::string::npos) << text;
  EXPECT_EQ(text.find("x_mm"), std::string::npos) << text;
}

TEST(MatFile, ConvertsNamesToValidMatlabNames) {
  EXPECT_EQ(matlab_name("left displacement.mm"), "left_displacement_mm");
  EXPECT_EQ(matlab_name("2nd_mm"), "x_2nd_mm");
  EXPECT_EQ(matlab_name(""), "x_");
  EXPECT_EQ(matlab_name(std::string(80, 'a')).size(), 63U);
}

TEST(McapFile, IsReproducibleAndFramedByTheMagicBytes) {
  const std::string bytes = mcap_bytes(two_fingers(), "test");
  EXPECT_TRUE(bytes.starts_with("\x89MCAP0\r\n"));
  EXPECT_TRUE(bytes.ends_with("\x89MCAP0\r\n"));
  EXPECT_EQ(bytes, mcap_bytes(two_fingers(), "test"));
  EXPECT_NE(bytes.find("{\"time_s\":0.01,\"state\":\"a,b\"}"), std::string::npos);
  EXPECT_NE(mcap_bytes({}, "test").size(), 0U);
}

}  // namespace
}  // namespace softgrip::tools::signals_test
