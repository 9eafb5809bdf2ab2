#include "sysid/import/mcap_topics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace softgrip::sysid::mcap_topics_test {
namespace {

TableColumn column(const std::string& name, std::vector<double> values) {
  TableColumn made;
  made.name = name;
  made.values = std::move(values);
  return made;
}

McapTopic topic(const std::string& name, std::vector<TableColumn> columns, std::vector<std::size_t> rows) {
  McapTopic made;
  made.name = name;
  made.columns = std::move(columns);
  made.rows = std::move(rows);
  return made;
}

std::vector<std::uint64_t> seconds(std::size_t count) {
  std::vector<std::uint64_t> times;
  for (std::size_t i = 0; i < count; ++i) times.push_back((7 + i) * 1'000'000'000);
  return times;
}

McapMessages signals() {
  McapMessages messages;
  messages.topics = {topic("pressure", {column("data", {10, 20})}, {0, 2}),
                     topic("displacement", {column("data", {1, 2})}, {1, 3})};
  messages.log_times = seconds(4);
  return messages;
}

TEST(McapTopics, SignalTopicsDescribeAFingerOnlyTogether) {
  EXPECT_TRUE(has_topics_of_signals(signals()));
  McapMessages fingers;
  for (const char* name : {"left", "right"}) {
    fingers.topics.push_back(topic(name, {column("pressure", {1, 2}), column("displacement", {3, 4})}, {}));
  }
  EXPECT_TRUE(fingers.topics[0].is_finger());
  EXPECT_FALSE(has_topics_of_signals(fingers));
  McapMessages one = signals();
  one.topics.pop_back();
  EXPECT_FALSE(has_topics_of_signals(one));
}

TEST(McapTopics, SignalTopicsAreMergedByRecordingTime) {
  McapMessages messages = signals();
  ForeignTable table;
  EXPECT_FALSE(merge_signals(messages, table));
  EXPECT_TRUE(table.has_rows_of_signals);
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.columns[0].name, "log_time");
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(table.columns[1].name, "pressure");
  EXPECT_EQ(table.columns[1].values[2], 20);
  EXPECT_TRUE(std::isnan(table.columns[1].values[1]));
  EXPECT_EQ(table.columns[2].name, "displacement");
  EXPECT_EQ(table.columns[2].values[3], 2);
}

TEST(McapTopics, SignalTopicsWithTwoClocksAreNotMerged) {
  McapMessages messages = signals();
  messages.topics[0].columns.push_back(column("time_s", {0, 2}));
  messages.topics[1].columns.push_back(column("time_s", {101, 103}));
  ForeignTable table;
  const auto problem = merge_signals(messages, table);
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->message.find("'pressure' and 'displacement' come from two clocks"), std::string::npos)
      << problem->message;
}

TEST(McapTopics, FingerTopicsShareTheTableColumns) {
  McapMessages messages;
  messages.topics = {topic("left", {column("pressure", {1, 2})}, {0, 2}),
                     topic("right", {column("pressure", {3, 4})}, {1, 3})};
  messages.log_times = seconds(4);
  ForeignTable table;
  join_fingers(messages, table);
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{1, 3, 2, 4}));
  EXPECT_EQ(table.columns[1].name, "log_time");
}

}  // namespace
}  // namespace softgrip::sysid::mcap_topics_test
