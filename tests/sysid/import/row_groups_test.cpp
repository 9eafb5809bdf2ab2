#include "sysid/import/row_groups.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::row_groups_test {
namespace {

TEST(RowGroups, IdentifiersNameGroups) {
  for (const char* name : {"id", "ID", "Run no", "sensor_id2", "log/device", "trial"})
    EXPECT_TRUE(names_group(name)) << name;
  for (const char* name : {"sample", "state", "run_time_s", "idle", "width"})
    EXPECT_FALSE(names_group(name)) << name;
}

/// Columns: time, id, reading.
ForeignTable table_of(std::vector<double> time, std::vector<double> id, std::vector<double> reading) {
  ForeignTable table;
  table.columns.resize(3);
  table.columns[0].values = std::move(time);
  table.columns[1].name = "id";
  table.columns[1].values = std::move(id);
  table.columns[2].values = std::move(reading);
  return table;
}

std::optional<RowGroups> groups_of(const ForeignTable& table) {
  RoleSources sources;
  sources.of_roles[static_cast<std::size_t>(Role::time)].columns = {0};
  sources.of_roles[static_cast<std::size_t>(Role::displacement)].columns = {2};
  ForeignSamples samples;
  for (std::size_t i = 0; i < table.rows(); ++i) samples.row.push_back(i);
  samples[Role::time] = table.columns[0].values;
  samples[Role::displacement] = table.columns[2].values;
  return row_groups(table, sources, samples);
}

TEST(RowGroups, TheTimesOfEachGroupIncrease) {
  const auto groups = groups_of(table_of({0, 1, 2, 0, 1, 2}, {7, 7, 7, 9, 9, 9}, {1, 2, 3, 1, 2, 3}));
  ASSERT_TRUE(groups);
  EXPECT_EQ(groups->column, "id");
  EXPECT_EQ(groups->values, (std::vector<double>{7, 9}));
  EXPECT_TRUE(groups->by_times);
  EXPECT_FALSE(groups_of(table_of({0, 1, 2, 0, 1, 2}, {7, 7, 9, 7, 9, 9}, {1, 2, 3, 1, 2, 3})));
}

TEST(RowGroups, OneRunIsNotSeparated) {
  EXPECT_FALSE(groups_of(table_of({0, 1, 2, 3}, {7, 7, 9, 9}, {1, 2, 3, 4})));
  EXPECT_FALSE(groups_of(table_of({0, 1, 2, 3}, {7, 9, 7, 9}, {1, 2, 3, 4})));
  EXPECT_FALSE(groups_of(table_of({0, 1, 0, 1}, {7, 7, 7, 7}, {1, 2, 3, 4})));
}

TEST(RowGroups, ReadingsOfTwoDevicesInTurnAreSeparated) {
  const auto groups = groups_of(table_of({0, 1, 2, 3, 4, 5}, {7, 9, 7, 9, 7, 9}, {1, 20, 2, 21, 3, 22}));
  ASSERT_TRUE(groups);
  EXPECT_FALSE(groups->by_times);
}

TEST(RowGroups, TheTextStatesHowToSplitTheRows) {
  ForeignTable table = table_of({0}, {7}, {1});
  const RowGroups groups{"id", {7, 9}, true};
  EXPECT_NE(about_groups(table, groups).find("Export the rows of each value"), std::string::npos);
  table.has_separators = true;
  EXPECT_NE(about_groups(table, groups)
                .find("rename the column 'id' to 'channel', and select the rows of one value with "
                      "--channel 7"),
            std::string::npos);
}

}  // namespace
}  // namespace softgrip::sysid::row_groups_test
