#include "sysid/import/cell_value.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace softgrip::sysid::cell_value_test {
namespace {

std::string ambiguous(const std::vector<std::string>& cells) {
  DecimalCommas commas;
  std::vector<double> values;
  for (const std::string& text : cells) {
    const CellValue cell = cell_value(text, {});
    commas.add(cell, text);
    if (cell.kind == CellKind::number) values.push_back(cell.number);
  }
  return commas.ambiguous_cell(values);
}

TEST(DecimalCommas, CommasThatCanSeparateThousandsAreAmbiguous) {
  EXPECT_EQ(ambiguous({"467", "\"5,582\"", "20,000"}), "5,582");
  EXPECT_EQ(ambiguous({"-20,000", "1500"}), "-20,000");
  EXPECT_EQ(ambiguous({"20,000", "1,020,000"}), "20,000");
}

TEST(DecimalCommas, CommasWithAClearMeaningAreAccepted) {
  EXPECT_EQ(ambiguous({"1", "2.5"}), "");
  EXPECT_EQ(ambiguous({"20,000", "35,314", "-", ""}), "") << "three decimals in each cell";
  EXPECT_EQ(ambiguous({"0,125", "12,500", "3"}), "") << "a group of thousands does not begin with 0";
  EXPECT_EQ(ambiguous({"20,000", "35,31", "3"}), "");
  EXPECT_EQ(ambiguous({"20,000", "1234,500", "3"}), "");
}

TEST(DecimalCommas, CodeForAMissingValueNeedsNoComma) {
  std::vector<std::string> cells;
  for (int i = 0; i < 30; ++i) cells.push_back("12," + std::to_string(500 + i));
  cells[7] = cells[9] = "999";
  EXPECT_EQ(ambiguous(cells), "");
  cells[9] = "467";
  EXPECT_EQ(ambiguous(cells), "12,500");
}

}  // namespace
}  // namespace softgrip::sysid::cell_value_test
