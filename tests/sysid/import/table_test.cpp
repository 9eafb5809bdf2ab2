#include "sysid/import/table.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace softgrip::sysid::table_test {
namespace {

void add(ArrayCollector& arrays, const std::string& name, std::size_t rows, std::size_t columns) {
  arrays.add(name, {}, rows, columns, std::vector<double>(rows * columns, 1));
}

std::vector<std::string> names_of(const ArrayCollector& arrays) {
  document::Problems problems;
  const auto table = arrays.table("HDF5", problems);
  EXPECT_TRUE(table) << problems.format();
  std::vector<std::string> names;
  for (const TableColumn& column : table ? table->columns : std::vector<TableColumn>{})
    names.push_back(column.name);
  return names;
}

TEST(ArrayCollector, TheLengthWithTheMostValuesIsUsed) {
  ArrayCollector arrays("m.mat");
  add(arrays, "t", 600, 1);
  add(arrays, "R1", 3, 3);
  add(arrays, "R2", 3, 3);
  add(arrays, "tip", 600, 1);
  EXPECT_EQ(names_of(arrays), (std::vector<std::string>{"t", "tip"}));
}

TEST(ArrayCollector, OneLongArrayDoesNotHideTheOthers) {
  ArrayCollector arrays("m.mat");
  add(arrays, "image", 100'000, 1);
  add(arrays, "t", 600, 1);
  add(arrays, "tip", 600, 1);
  EXPECT_EQ(names_of(arrays), (std::vector<std::string>{"t", "tip"}));
}

TEST(ArrayCollector, TheLongerArraysAreUsedIfTwoLengthsHaveEquallyManyValues) {
  ArrayCollector arrays("m.mat");
  for (const char* name : {"a", "b", "c", "d"}) add(arrays, name, 300, 1);
  for (const char* name : {"t", "tip"}) add(arrays, name, 600, 1);
  EXPECT_EQ(names_of(arrays), (std::vector<std::string>{"t", "tip"}));
}

TEST(ArrayCollector, ArraysOfDifferentLengthsAreRefused) {
  ArrayCollector arrays("m.mat");
  add(arrays, "t", 600, 1);
  add(arrays, "tip", 500, 1);
  document::Problems problems;
  EXPECT_FALSE(arrays.table("HDF5", problems));
  EXPECT_NE(problems.format().find("'tip' is skipped: 500 values, but other arrays have 600"),
            std::string::npos)
      << problems.format();
}

}  // namespace
}  // namespace softgrip::sysid::table_test
