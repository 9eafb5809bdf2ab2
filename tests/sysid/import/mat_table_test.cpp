#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "sysid/import/table_readers.h"

// tests/system/foreign_files.py writes complete .mat files in different layouts.
namespace softgrip::sysid::mat_table_test {
namespace {

/// Returns a variable of a MATLAB file of version 4 with two numbers.
std::string variable(char name) {
  const std::uint32_t header[] = {0, 2, 1, 0, 2};
  const double values[] = {1.5, 2.5};
  std::string bytes(sizeof header + 2 + sizeof values, '\0');
  std::memcpy(bytes.data(), header, sizeof header);
  bytes[sizeof header] = name;
  std::memcpy(bytes.data() + sizeof header + 2, values, sizeof values);
  return bytes;
}

std::vector<std::string> notes_of(const std::string& path, std::size_t variables) {
  document::Problems problems;
  const auto table = read_mat_table("m.mat", path, variables, problems);
  EXPECT_TRUE(table) << problems.format();
  return table ? table->notes : std::vector<std::string>{};
}

TEST(MatTable, VariablesThatLibmatioDoesNotReadAreCounted) {
  const std::string path = testing::TempDir() + "mat_table_test.mat";
  std::ofstream(path, std::ios::binary) << variable('a') << variable('b');
  const auto said = [](const std::string& text) {
    return std::vector{text + " at the end of the file cannot be read"};
  };
  EXPECT_TRUE(notes_of(path, 2).empty());
  EXPECT_EQ(notes_of(path, 3), said("1 variable"));
  EXPECT_EQ(notes_of(path, 4), said("2 variables"));
}

}  // namespace
}  // namespace softgrip::sysid::mat_table_test
