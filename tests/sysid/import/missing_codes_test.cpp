#include "sysid/import/missing_codes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::sysid::missing_codes_test {
namespace {

/// Returns a table of a time, a reading and a column of dates, with -999 in each column.
ForeignTable table_with_codes() {
  ForeignTable table;
  for (const char* name : {"t_s", "tip_mm", "date"}) {
    TableColumn column;
    column.name = name;
    column.values = {-999, 0, 1};
    table.columns.push_back(column);
  }
  table.columns[2].moments = 3;
  return table;
}

TEST(MissingCodes, ApplyToTheTimeButNotToDates) {
  const ForeignTable table = table_with_codes();
  Mapping mapping;
  mapping.missing = {"-999", "lost"};
  mapping.missing_in = {{"t_s", 1}, {"date", 1}};
  EXPECT_EQ(missing_codes(table, mapping, 0), (std::vector<double>{-999, 1}));
  EXPECT_EQ(missing_codes(table, mapping, 1), std::vector<double>{-999});
  EXPECT_EQ(missing_codes(table, mapping, 2), std::vector<double>{});
  const std::vector<double> time = without_codes(table, mapping, 0);
  EXPECT_TRUE(std::isnan(time[0]));
  EXPECT_EQ(time[1], 0);
  EXPECT_TRUE(std::isnan(time[2]));
  EXPECT_EQ(without_codes(table, mapping, 2), table.columns[2].values);
}

TEST(MissingCodes, ARepeatedCommandIsNoCode) {
  TableColumn column;
  for (int i = 0; i < 200; ++i) column.values.push_back(i % 20 == 7 ? 60 : i % 2);
  EXPECT_EQ(codes_for(column, Role::command), std::vector<double>{});
  EXPECT_EQ(codes_for(column, Role::pressure), std::vector<double>{60});
  column.values[3] = 999;
  EXPECT_EQ(codes_for(column, Role::command), std::vector<double>{999});
}

}  // namespace
}  // namespace softgrip::sysid::missing_codes_test
