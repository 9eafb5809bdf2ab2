#include "sysid/import/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>

namespace softgrip::sysid::motion_test {
namespace {

template <class Value>
TableColumn column(const std::string& name, Value value) {
  TableColumn made;
  made.name = name;
  for (int i = 0; i < 200; ++i) made.values.push_back(value(i));
  return made;
}

double motion(int i) {
  return 10 * std::sin(0.05 * i);
}

ForeignTable table_of(std::vector<TableColumn> columns) {
  ForeignTable table;
  table.columns = std::move(columns);
  return table;
}

std::vector<std::size_t> moving(const ForeignTable& table) {
  std::vector<std::size_t> all(table.columns.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return moving_columns(table, all);
}

TEST(Motion, AConstantAndNoiseDoNotMove) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(3, 0.05);
  const ForeignTable table =
      table_of({column("x_mm", [](int) { return 3.0; }), column("n_V", [&](int) { return noise(random); }),
                column("y_deg", [](int i) { return motion(i); })});
  EXPECT_EQ(moving(table), std::vector<std::size_t>{2});
}

TEST(Motion, ASmallSpanInTheSameUnitDoesNotMove) {
  const ForeignTable table =
      table_of({column("x_mm", [](int i) { return 0.05 * motion(i); }), column("y_mm", motion),
                column("z_cm", [](int i) { return 0.05 * motion(i); }),
                column("w_mm", [](int i) { return 0.3 * motion(i); })});
  EXPECT_EQ(moving(table), (std::vector<std::size_t>{1, 2, 3}));
}

TEST(Motion, CodesForMissingValuesDoNotMove) {
  const ForeignTable table =
      table_of({column("x_mm", [](int i) { return i % 60 == 7 ? 999.0 : 3.0; }), column("y_mm", motion)});
  EXPECT_EQ(moving(table), std::vector<std::size_t>{1});
}

}  // namespace
}  // namespace softgrip::sysid::motion_test
