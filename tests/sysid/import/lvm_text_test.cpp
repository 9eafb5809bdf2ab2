#include "sysid/import/table_readers.h"

#include <gtest/gtest.h>

#include <string>

namespace softgrip::sysid::lvm_text_test {
namespace {

std::string header(const std::string& x_columns, const std::string& separator = "Tab") {
  return "LabVIEW Measurement\t\nSeparator\t" + separator + "\nDecimal_Separator\t,\nX_Columns\t" +
         x_columns + "\n***End_of_Header***\t\n\t\n";
}

std::string section(const std::string& time, const std::string& rows,
                    const std::string& names = "X_Value\tSet\tTip\tComment") {
  return "Channels\t2\t\t\nDate\t2024/06/13\t2024/06/13\nTime\t" + time +
         "\nY_Unit_Label\tkPa\tmm\nX0\t0,0\t0,0\nDelta_X\t0,5\t0,5\n***End_of_Header***\t\t\t\n" + names +
         "\n" + rows;
}

ForeignTable table_of(const std::string& text, const TableOptions& options = {}) {
  document::Problems problems;
  EXPECT_TRUE(is_lvm(text));
  auto table = read_lvm("t.lvm", text, options, problems);
  EXPECT_TRUE(table) << problems.format();
  return table ? *table : ForeignTable{};
}

TEST(Lvm, ReadsUnitsAndDecimalMarkFromTheHeader) {
  const ForeignTable table =
      table_of(header("One") + section("12:00:00,5", "0,0\t1,5\t2,5\n0,5\t3\t4\tnote\n"));
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.columns[0].unit, "s");
  EXPECT_EQ(table.columns[1].unit, "kPa");
  EXPECT_EQ(table.columns[2].unit, "mm");
  EXPECT_EQ(table.columns[2].values, (std::vector<double>{2.5, 4}));
  EXPECT_EQ(table.account.rows, 2U);
}

TEST(Lvm, TimesAreComputedWithoutATimeColumn) {
  const ForeignTable table = table_of(header("No") + section("12:00:00", "\t1\t2\n\t3\t4\n\t5\t6\n"));
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{0, 0.5, 1}));
}

TEST(Lvm, SectionsAreConcatenatedInTime) {
  const std::string rows = "0,0\t1\t2\n0,5\t3\t4\n";
  const ForeignTable same =
      table_of(header("One") + section("12:00:00", rows) + "\n" + section("12:00:00", rows));
  EXPECT_EQ(same.columns[0].values, (std::vector<double>{0, 0.5, 1, 1.5}));
  EXPECT_EQ(same.notes.size(), 1U);
  const ForeignTable later = table_of(header("One") + section("12:00:00", rows) + section("12:00:10", rows));
  EXPECT_EQ(later.columns[0].values, (std::vector<double>{0, 0.5, 10, 10.5}));
}

TEST(Lvm, DifferingOrTruncatedSectionsAreReported) {
  document::Problems problems;
  EXPECT_FALSE(read_lvm("t.lvm",
                        header("One") + section("12:00:00", "0\t1\t2\n") +
                            section("12:00:00", "0\t1\t2\n", "X_Value\tSet\tOther\tComment"),
                        {}, problems));
  EXPECT_NE(problems.format().find("the columns of this section differ"), std::string::npos);
  const ForeignTable cut = table_of(header("One") + section("12:00:00", "0\t1\t2\n0,5\t3"));
  EXPECT_EQ(cut.account.rows, 2U);
  EXPECT_EQ(cut.account.left_out[static_cast<std::size_t>(LeftOut::cut_off_line)], 1U);
  document::Problems short_line;
  EXPECT_FALSE(
      read_lvm("t.lvm", header("One") + section("12:00:00", "0\t1\t2\n0,5\n1\t3\t4\n"), {}, short_line));
  EXPECT_NE(short_line.format().find("too few cells"), std::string::npos);
  document::Problems many;
  std::string rows = "0\t1\t2\n0,5\n";
  for (int i = 1; i < 50; ++i) rows += std::to_string(i) + "\t3\t4\n";
  EXPECT_FALSE(read_lvm("t.lvm", header("One") + section("12:00:00", rows), {}, many));
  EXPECT_EQ(many.format(), short_line.format()) << "only the line with too few cells must be reported";
  EXPECT_FALSE(is_lvm("LabVIEW Measurement\nx\n"));
}

TEST(Lvm, LinesWithTooManyCellsAreRefusedOrLeftOut) {
  const std::string rows = "0\t1\t2\n0,5\t3\t77\t88\t4\n1\t5\t6\tnote\t\n1,5\t7\t8\n";
  document::Problems problems;
  EXPECT_FALSE(read_lvm("t.lvm", header("One") + section("12:00:00", rows), {}, problems));
  EXPECT_NE(problems.format().find("this line has 5 cells, but the table has 3 columns"), std::string::npos)
      << problems.format();
  TableOptions skipping;
  skipping.skip_bad_lines = true;
  const ForeignTable table = table_of(header("One") + section("12:00:00", rows), skipping);
  EXPECT_EQ(table.columns[2].values, (std::vector<double>{2, 6, 8}));
  EXPECT_EQ(table.account.left_out[static_cast<std::size_t>(LeftOut::bad_line)], 1U);
}

TEST(Lvm, OnlyATableWithCommentsHasAFurtherCell) {
  const std::string text = header("One") + section("12:00:00", "0\t1\t2\n1\t3\t4\t5\n", "X_Value\tSet\tTip");
  document::Problems problems;
  EXPECT_FALSE(read_lvm("t.lvm", text, {}, problems));
  EXPECT_NE(problems.format().find("this line has 4 cells, but the table has 3 columns"), std::string::npos)
      << problems.format();
}

TEST(Lvm, ASeparatorThatIsTheDecimalMarkIsRefused) {
  document::Problems problems;
  EXPECT_FALSE(read_lvm("t.lvm", header("One", "Comma") + section("12:00:00", "0,020,0,0074,0,00044\n"), {},
                        problems));
  EXPECT_NE(problems.format().find("t.lvm:3:1: the header states that commas separate the columns"),
            std::string::npos)
      << problems.format();
}

/// The limits on rows and file size are the same for a LabVIEW text file and for every other text file.
TEST(Lvm, HasTheSizeLimitsOfATextFile) {
  document::Problems problems;
  const std::string bytes = header("One") + section("12:00:00,0", "0\t1\t2\n1\t3\t4\n");
  EXPECT_FALSE(read_lvm("t.lvm", bytes + std::string(most_rows, '\n'), {}, problems));
  EXPECT_EQ(problems.list().front().message, "the text has more than 16777216 lines");
  const ForeignTable table = table_of(bytes + std::string(64, '\0'));
  EXPECT_EQ(table.rows(), 2U);
  ASSERT_EQ(table.notes.size(), 1U);
  EXPECT_EQ(table.notes.front(), "64 NUL bytes at the end of the file are left out");
}

TEST(Lvm, LimitsTheNumberOfValues) {
  std::string names = "X_Value";
  for (int i = 0; i < 2000; ++i) names += "\tY" + std::to_string(i);
  document::Problems problems;
  const std::string rows = std::string(80'000, '\n') + "0";
  EXPECT_FALSE(read_lvm("t.lvm", header("One") + section("12:00:00,0", rows, names), {}, problems));
  EXPECT_EQ(problems.list().front().message, "the text has more than 134217728 values");
}

}  // namespace
}  // namespace softgrip::sysid::lvm_text_test
