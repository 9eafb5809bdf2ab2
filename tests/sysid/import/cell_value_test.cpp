#include "sysid/import/cell_value.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace softgrip::sysid::cell_value_test {
namespace {

std::string ambiguous(const std::vector<std::string>& cells) {
  DecimalMarks commas;
  std::vector<double> values;
  for (const std::string& text : cells) {
    const CellValue cell = cell_value(text, {});
    commas.add(cell, text);
    if (cell.kind == CellKind::number) values.push_back(cell.number);
  }
  return commas.ambiguous_cell(values);
}

TEST(DecimalMarks, CommasThatCanSeparateThousandsAreAmbiguous) {
  EXPECT_EQ(ambiguous({"467", "\"5,582\"", "20,000"}), "5,582");
  EXPECT_EQ(ambiguous({"-20,000", "1500"}), "-20,000");
  EXPECT_EQ(ambiguous({"20,000", "1,020,000"}), "20,000");
}

TEST(DecimalMarks, CommasWithAClearMeaningAreAccepted) {
  EXPECT_EQ(ambiguous({"1", "2.5"}), "");
  EXPECT_EQ(ambiguous({"20,000", "35,314", "-", ""}), "") << "three decimals in each cell";
  EXPECT_EQ(ambiguous({"0,125", "12,500", "3"}), "") << "a group of thousands does not begin with 0";
  EXPECT_EQ(ambiguous({"20,000", "35,31", "3"}), "");
  EXPECT_EQ(ambiguous({"20,000", "1234,500", "3"}), "");
}

TEST(DecimalMarks, CodeForAMissingValueNeedsNoComma) {
  std::vector<std::string> cells;
  for (int i = 0; i < 30; ++i) cells.push_back("12," + std::to_string(500 + i));
  cells[7] = cells[9] = "999";
  EXPECT_EQ(ambiguous(cells), "");
  cells[9] = "467";
  EXPECT_EQ(ambiguous(cells), "12,500");
}

TEST(DecimalMarks, PointsThatCanSeparateThousandsAreAmbiguous) {
  EXPECT_EQ(ambiguous({"467", "980", "1.234"}), "1.234");
  EXPECT_EQ(ambiguous({"-20.000", "1500", "7"}), "-20.000");
  EXPECT_EQ(ambiguous({"20.000", "1.020.000"}), "20.000");
}

TEST(DecimalMarks, PointsWithAClearMeaningAreAccepted) {
  EXPECT_EQ(ambiguous({"1.250", "12.500", "-", ""}), "") << "three decimals in each cell";
  EXPECT_EQ(ambiguous({"0.125", "12.500", "3", "4"}), "") << "a group of thousands does not begin with 0";
  EXPECT_EQ(ambiguous({"1", "2", "1.25", "1.375"}), "") << "two decimals";
  EXPECT_EQ(ambiguous({"1", "2", "1234.500", "1.375"}), "") << "four digits before the point";
  EXPECT_EQ(ambiguous({"1", "2", "1.375e3", "1.375"}), "") << "an exponent";
  EXPECT_EQ(ambiguous({"0", "0", "12.345", "13.456"}), "") << "only the value at rest has no point";
}

TEST(CellValue, OnlyNumbersHaveADecimalMark) {
  EXPECT_TRUE(cell_value("1,5", {}).with_comma);
  for (const char* text : {"step 1,5", "2024-05-31 12:00:00,250", "1,5 V", "1,5,7"})
    EXPECT_FALSE(cell_value(text, {}).with_comma) << text;
}

}  // namespace
}  // namespace softgrip::sysid::cell_value_test
