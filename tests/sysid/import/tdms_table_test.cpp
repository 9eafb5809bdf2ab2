#include "sysid/import/table_readers.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

// tests/system/foreign_files.py writes complete TDMS files in different layouts. This file tests single
// segments.
namespace softgrip::sysid::tdms_table_test {
namespace {

template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

std::string text_of(const std::string& text) {
  return bytes_of(static_cast<std::uint32_t>(text.size())) + text;
}

std::string segment(std::uint32_t flags, const std::string& metadata, const std::string& raw) {
  return "TDSm" + bytes_of(flags) + bytes_of(std::uint32_t{4713}) +
         bytes_of(static_cast<std::uint64_t>(metadata.size() + raw.size())) +
         bytes_of(static_cast<std::uint64_t>(metadata.size())) + metadata + raw;
}

/// Returns the metadata of a channel. The channel has `count` values and no properties.
std::string channel(const std::string& path, std::uint32_t type, std::uint64_t count) {
  return text_of(path) + bytes_of(std::uint32_t{20}) + bytes_of(type) + bytes_of(std::uint32_t{1}) +
         bytes_of(count) + bytes_of(std::uint32_t{0});
}

std::string number_of_objects(std::uint32_t count) {
  return bytes_of(count);
}

std::string two_channels() {
  const std::string metadata =
      number_of_objects(2) + channel("/'g'/'it''s'", 10, 2) + channel("/'g'/'b'", 3, 2);
  return segment(2 | 4 | 8, metadata,
                 bytes_of(1.5) + bytes_of(2.5) + bytes_of(std::int32_t{-7}) + bytes_of(std::int32_t{8}));
}

std::string refusal(const std::string& bytes) {
  document::Problems problems;
  EXPECT_FALSE(read_tdms_table("m.tdms", bytes, problems));
  return problems.format();
}

ForeignTable table_of(const std::string& bytes) {
  document::Problems problems;
  auto table = read_tdms_table("m.tdms", bytes, problems);
  EXPECT_TRUE(table) << problems.format();
  return table ? *table : ForeignTable{};
}

TEST(TdmsTable, ReadsNumbersByTheirTypes) {
  const ForeignTable table = table_of(two_channels());
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[0].name, "g/it's");
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(table.columns[1].values, (std::vector<double>{-7, 8}));
}

TEST(TdmsTable, MetadataApplyUntilChanged) {
  // The second segment has no metadata. The third segment changes the number of values of both channels from
  // 2 to 1. All other metadata stay unchanged.
  const std::string values =
      bytes_of(3.5) + bytes_of(4.5) + bytes_of(std::int32_t{9}) + bytes_of(std::int32_t{10});
  const std::string change =
      number_of_objects(2) + channel("/'g'/'it''s'", 10, 1) + channel("/'g'/'b'", 3, 1);
  const ForeignTable table =
      table_of(two_channels() + segment(8, "", values) +
               segment(2 | 8 | 32, change, bytes_of(5.5) + bytes_of(std::int32_t{11})));
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{1.5, 2.5, 3.5, 4.5, 5.5}));
  EXPECT_EQ(table.columns[1].values, (std::vector<double>{-7, 8, 9, 10, 11}));
}

/// The metadata of a segment without a new channel list change the channels that they name. All other
/// channels keep their metadata.
TEST(TdmsTable, ChangedMetadataKeepsTheOtherChannels) {
  const auto more = [](std::uint64_t count, double first, std::int32_t second) {
    std::string values;
    for (std::uint64_t i = 0; i < count; ++i) values += bytes_of(first + static_cast<double>(i));
    return segment(2 | 8, number_of_objects(1) + channel("/'g'/'it''s'", 10, count),
                   values + bytes_of(second) + bytes_of(second + 1));
  };
  const ForeignTable table = table_of(two_channels() + more(1, 3.5, 9) + more(3, 4.5, 11));
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{1.5, 2.5, 3.5, 4.5, 5.5, 6.5}));
  EXPECT_EQ(table.columns[1].values, (std::vector<double>{-7, 8, 9, 10, 11, 12}));
}

TEST(TdmsTable, RefusesUnsupportedOrInvalidSegments) {
  std::string bytes = two_channels();
  bytes[4] = static_cast<char>(bytes[4] | 64);
  EXPECT_NE(refusal(bytes).find("the segment at byte 0 is big-endian"), std::string::npos);
  EXPECT_NE(refusal(two_channels() + std::string(40, 'x')).find("does not begin with TDSm"),
            std::string::npos);
  EXPECT_NE(refusal(segment(2 | 4, number_of_objects(5), "")).find("broken metadata"), std::string::npos);
}

/// A program that is stopped leaves an incomplete last segment. The reader must read the complete segments
/// before it.
TEST(TdmsTable, KeepsTheCompleteSegmentsOfAFileThatIsCutOff) {
  const std::string good = two_channels();
  const std::string metadata =
      number_of_objects(2) + channel("/'g'/'it''s'", 10, 2) + channel("/'g'/'b'", 3, 2);
  const auto cut_at = [&](std::size_t bytes_of_second) {
    return table_of(good + two_channels().substr(0, bytes_of_second));
  };
  const auto notes = [](const ForeignTable& table) { return table.notes.empty() ? "" : table.notes.back(); };
  for (const std::size_t bytes : {std::size_t{20}, std::size_t{28}, std::size_t{40}, 27 + metadata.size()}) {
    const ForeignTable table = cut_at(bytes);
    EXPECT_EQ(table.columns[0].values, (std::vector<double>{1.5, 2.5})) << bytes;
    EXPECT_EQ(notes(table), "the segment at byte " + std::to_string(good.size()) + " is cut off in its " +
                                (bytes < 28 ? "first bytes" : "metadata") + ": its " + std::to_string(bytes) +
                                " bytes are left out");
  }
  // The segment has 2 rows. The file ends after the first value of the first channel, so no row of this
  // segment is complete.
  const ForeignTable blocks = cut_at(28 + metadata.size() + 12);
  EXPECT_EQ(blocks.columns[1].values, (std::vector<double>{-7, 8}));
  EXPECT_EQ(notes(blocks), "incomplete rows or blocks of values are left out: 12 bytes");
  EXPECT_EQ(blocks.account.rows, 2U);
  EXPECT_EQ(blocks.account.left_out[static_cast<std::size_t>(LeftOut::cut_off_line)], 2U);
  EXPECT_NE(refusal(good.substr(0, 60)).find("the segment at byte 0 ends before the end of its metadata"),
            std::string::npos);
}

TEST(TdmsTable, ReportsUnsupportedTypesAndProperties) {
  const auto said = [](std::uint32_t objects, const std::string& inside) {
    return refusal(segment(2 | 4 | 8, number_of_objects(objects) + inside, "x"));
  };
  const std::string complex = said(1, channel("/'g'/'z'", 0x10000d, 2));
  EXPECT_NE(complex.find("has values in 'g/z' of type 1048589, which is not supported"), std::string::npos)
      << complex;
  const std::string changed = said(2, channel("/'g'/'z'", 10, 2) + channel("/'g'/'z'", 3, 2));
  EXPECT_NE(changed.find("changes the type of the values of the channel in 'g/z'"), std::string::npos)
      << changed;
  std::string fixed_point = channel("/'g'/'z'", 10, 2);
  fixed_point.replace(fixed_point.size() - 4, 4,
                      bytes_of(std::uint32_t{1}) + text_of("gain") + bytes_of(std::uint32_t{0x4f}));
  EXPECT_NE(said(1, fixed_point).find("has a property 'gain' of type 79"), std::string::npos);
  const std::string daqmx = said(1, text_of("/'g'/'z'") + bytes_of(std::uint32_t{0x1269}));
  EXPECT_NE(daqmx.find("has raw values of DAQmx"), std::string::npos) << daqmx;
  std::string many;
  for (int i = 0; i <= 10'000; ++i) many += channel("/'g'/'" + std::to_string(i) + "'", 1, 1);
  EXPECT_NE(said(10'001, many).find("exceeds the limit of 10000 channels"), std::string::npos);
}

TEST(TdmsTable, RefusesMoreValuesThanTheLimit) {
  const std::size_t count = most_values + 1;
  const std::string metadata = number_of_objects(1) + channel("/'g'/'z'", 1, count);
  EXPECT_NE(refusal(segment(2 | 4 | 8, metadata, std::string(count, 'x'))).find("more than 134217728 values"),
            std::string::npos);
}

/// If bytes of the file are missing or changed, the reader must refuse the file or return a table.
TEST(TdmsTable, DamagedFileGivesATableOrAnError) {
  const std::string good = two_channels() + two_channels();
  std::mt19937 random(5);
  for (std::size_t i = 0; i < 20 * good.size(); ++i) {
    std::string bytes = i < good.size() ? good.substr(0, i) : good;
    if (i >= good.size()) bytes[i % good.size()] = static_cast<char>(random());
    document::Problems problems;
    const auto table = read_tdms_table("m.tdms", bytes, problems);
    ASSERT_EQ(table.has_value(), problems.empty()) << i;
  }
}

TEST(TdmsTable, LimitsTheWorkForSmallFiles) {
  std::string metadata = number_of_objects(5000);
  for (int i = 0; i < 5000; ++i) metadata += channel("/'g'/'" + std::to_string(i) + "'", 1, 0);
  metadata.replace(0, 4, number_of_objects(5001));
  metadata += channel("/'g'/'last'", 1, 1);
  std::string bytes = segment(2 | 4 | 8, metadata, "x");
  for (int i = 0; i < 30'000; ++i) bytes += segment(8, "", "x");
  EXPECT_NE(refusal(bytes).find("pieces of channels"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::sysid::tdms_table_test
