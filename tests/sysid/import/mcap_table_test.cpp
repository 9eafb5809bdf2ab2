#include "sysid/import/mcap_table.h"

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "sysid/import/byte_scanner.h"

// tests/system/test_import.py tests the import of files that `softgrip export` has written.
namespace softgrip::sysid::mcap_table_test {
namespace {

template <class T>
std::string number(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

std::string text(const std::string& text) {
  return number(static_cast<std::uint32_t>(text.size())) + text;
}

std::string record(McapOpcode kind, const std::string& content) {
  return number(static_cast<std::uint8_t>(kind)) + number(static_cast<std::uint64_t>(content.size())) +
         content;
}

std::string topic(std::uint16_t id, const std::string& name, const std::string& encoding = "json") {
  return record(McapOpcode::channel, number(id) + number(std::uint16_t{0}) + text(name) + text(encoding) +
                                         number(std::uint32_t{0}));
}

std::string message(std::uint16_t id, std::uint64_t time_ns, const std::string& json) {
  return record(McapOpcode::message,
                number(id) + number(std::uint32_t{0}) + number(time_ns) + number(time_ns) + json);
}

std::string chunk(const std::string& records, const std::string& packing = "", std::uint32_t spoiled = 0) {
  const auto* const data = reinterpret_cast<const Bytef*>(records.data());
  const auto checksum = static_cast<std::uint32_t>(::crc32_z(0, data, records.size()));
  return record(McapOpcode::chunk, std::string(24, '\0') + number(checksum ^ spoiled) + text(packing) +
                                       number(static_cast<std::uint64_t>(records.size())) + records);
}

std::string begun(const std::string& records) {
  return std::string(mcap_magic) + record(McapOpcode::header, text("") + text("test")) + records;
}

std::string whole(const std::string& records) {
  return begun(records) + record(McapOpcode::data_end, std::string(4, '\0')) +
         record(McapOpcode::footer, std::string(20, '\0')) + std::string(mcap_magic);
}

std::string two_fingers() {
  return topic(1, "/left") + topic(2, "/right") +
         message(1, 0, R"({"time_s":0,"tip_mm":1.5,"state":"idle"})") +
         message(2, 0, R"({"time_s":0,"tip_mm":7})") +
         message(1, 500'000'000, R"({"time_s":0.5,"tip_mm":2.5,"valve":{"open":true}})");
}

std::optional<ForeignTable> read(const std::string& bytes, document::Problems& problems,
                                 const TableOptions& options = {}) {
  return read_mcap_table("r.mcap", bytes, options, problems);
}

ForeignTable table_of(const std::string& bytes, const TableOptions& options = {}) {
  document::Problems problems;
  auto table = read(bytes, problems, options);
  EXPECT_TRUE(table) << problems.format();
  return table ? *table : ForeignTable{};
}

std::string refusal(const std::string& bytes, const TableOptions& options = {}) {
  document::Problems problems;
  EXPECT_FALSE(read(bytes, problems, options));
  return problems.format();
}

bool says(const std::string& said, const std::string& part) {
  return said.find(part) != std::string::npos;
}

std::size_t left_out(const ForeignTable& table, LeftOut reason) {
  return table.account.left_out[static_cast<std::size_t>(reason)];
}

const std::vector<double>& column(const ForeignTable& table, const std::string& name) {
  const std::size_t index = column_index(table, name);
  static const std::vector<double> none;
  return index < table.columns.size() ? table.columns[index].values : none;
}

TEST(ByteScanner, ReturnsNoDataBeyondTheEnd) {
  ByteScanner scan(std::string_view("\x02\0\0\0ab\x07", 7));
  EXPECT_EQ(scan.text(), "ab");
  EXPECT_EQ(scan.rest().size(), 1U);
  EXPECT_EQ(scan.value<std::uint16_t>(), 0);
  EXPECT_FALSE(scan.good());
  EXPECT_EQ(scan.value<std::uint8_t>(), 0);
  EXPECT_EQ(scan.skip(1), nullptr);
}

TEST(McapTable, TakesTheMessagesOfOneTopic) {
  for (const std::string& bytes : {whole(two_fingers()), whole(chunk(two_fingers()))}) {
    TableOptions options;
    options.channel = "left";
    const ForeignTable table = table_of(bytes, options);
    EXPECT_EQ(table.channels, (std::vector<std::string>{"left", "right"}));
    EXPECT_EQ(column(table, "time_s"), (std::vector<double>{0, 0.5}));
    EXPECT_EQ(column(table, "tip_mm"), (std::vector<double>{1.5, 2.5}));
    ASSERT_EQ(column(table, "valve.open").size(), 2U);
    EXPECT_TRUE(std::isnan(column(table, "valve.open")[0]));
    EXPECT_EQ(column(table, "valve.open")[1], 1);
    EXPECT_EQ(table.account.rows, 1U);
    EXPECT_EQ(left_out(table, LeftOut::other_channel), 1U);
    options.channel = "middle";
    const std::string said = refusal(bytes, options);
    EXPECT_TRUE(says(said, "no topic has the name 'middle'")) << said;
    EXPECT_TRUE(says(said, "left and right") || says(said, "left, right")) << said;
  }
}

TEST(McapTable, ReportsSkippedTopicsAndValues) {
  const ForeignTable table =
      table_of(whole(topic(1, "/signals") + topic(2, "/imu", "cdr") + message(2, 1, "xyz") +
                     message(1, 1'000'000'000'000'000'500, R"({"tip_mm":"stuck","raw":[1,2]})") +
                     message(1, 1'000'000'000'500'000'500, R"({"tip_mm":4,"p_kpa":"NaN"})")));
  EXPECT_TRUE(table.channels.empty());
  EXPECT_EQ(column(table, "log_time"), (std::vector<double>{0, 0.5}));
  ASSERT_EQ(table.columns[0].bad.size(), 1U);
  EXPECT_EQ(table.columns[0].bad[0].cell, "of message 1");
  EXPECT_EQ(table.notes,
            (std::vector<std::string>{"topic 'imu' is skipped: 1 messages are in 'cdr', not in JSON",
                                      "'raw' is skipped, because this value is an array"}));
}

TEST(McapTable, ReadsTheCompleteMessagesOfAFileThatIsCutOff) {
  const std::string last = message(1, 2, R"({"time_s":1,"tip_mm":9})");
  for (const std::string& bytes : {begun(two_fingers() + last), begun(chunk(two_fingers() + last))}) {
    const ForeignTable table = table_of(bytes.substr(0, bytes.size() - 3));
    EXPECT_EQ(column(table, "tip_mm"), (std::vector<double>{1.5, 7, 2.5}));
    EXPECT_EQ(left_out(table, LeftOut::cut_off_line), 1U);
    EXPECT_EQ(table.notes.back(),
              "the file is cut off: its last " + std::to_string(last.size() - 3) + " bytes are left out");
  }
}

TEST(McapTable, RefusesUnsupportedOrInvalidFiles) {
  EXPECT_TRUE(
      says(refusal(whole(chunk(two_fingers(), "zstd"))), "the chunks of the file are compressed with zstd"));
  EXPECT_TRUE(says(refusal(whole(chunk(two_fingers(), "", 1))), "a chunk does not match its checksum"));
  EXPECT_TRUE(says(refusal(whole(message(1, 0, "{}"))), "a message refers to an unknown channel"));
  EXPECT_TRUE(
      says(refusal(whole(topic(1, "/imu", "cdr") + message(1, 0, "{}"))), "no topic has messages in JSON"));
  std::string longer = whole(two_fingers());
  longer[mcap_magic.size() + 5] = 1;
  EXPECT_TRUE(says(refusal(longer), "a record is longer than the file"));
  const std::string bad = whole(two_fingers() + message(1, 3, "[1]") + message(1, 3, R"({"time_s":1e999})"));
  EXPECT_TRUE(says(refusal(bad), "message 4 is not a JSON object"));
  TableOptions options;
  options.skip_bad_lines = true;
  EXPECT_EQ(left_out(table_of(bad, options), LeftOut::bad_line), 2U);
  const std::string large = R"({"tip_mm":")" + std::string(std::size_t{1} << 20U, 'x') + R"("})";
  EXPECT_TRUE(says(refusal(whole(topic(1, "/left") + message(1, 0, large))), "at most 1048576 bytes"));
  std::string keys = "{\"k\":0";
  for (int i = 0; i < 10'000; ++i) keys += ",\"" + std::to_string(i) + "\":1";
  EXPECT_TRUE(says(refusal(whole(topic(1, "/left") + message(1, 0, keys + "}"))), "more than 10000 keys"));
}

/// If bytes of the file are missing or changed, the reader must refuse the file or return a table.
TEST(McapTable, DamagedFileGivesATableOrAnError) {
  const std::string good = whole(two_fingers() + chunk(two_fingers()));
  std::mt19937 random(11);
  for (std::size_t i = 0; i < 20 * good.size(); ++i) {
    std::string bytes = i < good.size() ? good.substr(0, i) : good;
    if (i < mcap_magic.size()) continue;
    if (i >= good.size()) bytes[i % good.size()] = static_cast<char>(random());
    if (!bytes.starts_with(mcap_magic)) continue;
    document::Problems problems;
    const auto table = read(bytes, problems);
    ASSERT_EQ(table.has_value(), problems.empty()) << i;
    if (!table) continue;
    for (const TableColumn& column : table->columns) ASSERT_EQ(column.values.size(), table->rows());
  }
}

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

}  // namespace softgrip::sysid::mcap_table_test
