#include "sysid/import/table_readers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sysid/import/cell_value.h"
#include "sysid/import/text_dialect.h"

namespace softgrip::sysid::text_table_test {
namespace {

ForeignTable table_of(const std::string& text, const TableOptions& options = {}) {
  document::Problems problems;
  auto table = parse_text_table("t.csv", text, options, problems);
  EXPECT_TRUE(table) << problems.format();
  return table ? *table : ForeignTable{};
}

std::string refusal(const std::string& text, const TableOptions& options = {}) {
  document::Problems problems;
  EXPECT_FALSE(parse_text_table("t.csv", text, options, problems));
  return problems.format();
}

TEST(TextTable, SeparatorsAreFound) {
  for (const char separator : {',', ';', '\t', '|', ' '}) {
    std::string text = "a,b,c\n1,2.5,3\n4,5.5,6\n";
    for (char& c : text) c = c == ',' ? separator : c;
    const ForeignTable table = table_of(text);
    ASSERT_EQ(table.columns.size(), 3U) << separator;
    EXPECT_EQ(table.columns[1].name, "b");
    EXPECT_EQ(table.columns[1].values, (std::vector<double>{2.5, 5.5}));
    EXPECT_EQ(table.line, (std::vector<int>{2, 3}));
  }
}

TEST(TextTable, DecimalMarksAreFoundBetweenSemicolonsBlanksAndInQuotes) {
  for (const char* text : {"a;b\n0,5;1\n1,5;2\n", "a b\n0,5 1\n1,5 2\n", "a,b\n\"0,5\",1\n\"1,5\",2\n"})
    EXPECT_EQ(table_of(text).columns[0].values, (std::vector<double>{0.5, 1.5})) << text;
}

TEST(TextTable, PointsAndCommasInOneFileAreRefused) {
  EXPECT_NE(refusal("a;b\n0,5;1\n1.5;2\n2,5;3\n").find("t.csv:3:1"), std::string::npos);
  EXPECT_NE(refusal("a,b\n0,5,1,5\n1,5,2,5\n").find("2 column names above 4 columns"), std::string::npos);
}

TEST(TextTable, UnitsAreReadFromTheLineBelowTheNames) {
  const ForeignTable table = table_of("time;p\n[ms];[psi]\n1;2\n3;4\n");
  EXPECT_EQ(table.columns[0].unit, "ms");
  EXPECT_EQ(table.columns[1].unit, "psi");
  EXPECT_EQ(table.columns[1].name, "p");
}

TEST(TextTable, CommentsAndTitleLinesAreSkipped) {
  const ForeignTable table = table_of("Report\nOperator: me\n# comment\n\nt,x\n0,1\n# more\n1,2\n");
  EXPECT_EQ(table.columns[1].name, "x");
  EXPECT_EQ(table.columns[1].values, (std::vector<double>{1, 2}));
  EXPECT_EQ(table.line, (std::vector<int>{6, 8}));
  EXPECT_EQ(table.notes, std::vector<std::string>{"2 lines above the columns' names skipped"});
}

TEST(TextTable, ColumnNamesMayBeInACommentOrMissing) {
  EXPECT_EQ(table_of("# t x\n0 1\n1 2\n").columns[1].name, "x");
  const ForeignTable nameless = table_of("0,1\n1,2\n");
  EXPECT_EQ(nameless.columns[1].name, "");
  EXPECT_EQ(column_index(nameless, "2"), 1U);
  EXPECT_EQ(word_of(nameless, 1), "2");
}

TEST(TextTable, NumbersOfTheColumnsAreNoSample) {
  for (const char* text :
       {"0,1,2\n0.00,20,6\n0.01,20.3,6.1\n0.02,20.5,6.2\n", "\"0\",\"1\"\n20,6\n20.3,6.1\n20.5,6.2\n",
        ",0,1,2\n0,0.00,1,2\n1,0.01,1,2\n2,0.02,1,2\n",
        "0;1;2\n12:00:00.0;20;6\n12:00:00.5;21;7\n12:00:01.0;22;8\n",
        "Report\n\n0 1 2\n7 20 6\n8 21 7\n9 22 8\n"}) {
    const std::string said = refusal(text);
    EXPECT_NE(said.find("this line has the numbers of the columns instead of their names"), std::string::npos)
        << text << said;
  }
  for (const char* text :
       {"0,1,2\n0.01,1.2,2.1\n0.02,1.3,2.3\n0.03,1.5,2.4\n", "0,1,2\n1,2,3\n2,3,4\n3,4,5\n",
        "0,1,2\n0.01,20,2.1\n0.02,20,2.2\n0.03,20,2.3\n", "0,1\n0.01,20\n0.02,20\n0.03,20\n"})
    EXPECT_EQ(table_of(text).columns[1].values.size(), 4U) << text;
  EXPECT_EQ(table_of("t,p,x\n0,1,2\n0,20,6\n1,21,7\n2,22,8\n").columns[2].values.front(), 2);
}

TEST(TextTable, MissingValueWordsAreReadAsNan) {
  const ForeignTable table = table_of("t,x\n0,NaN\n1,\n2,N/A\n3,-999\n4,inf\n5,7\n", {0, {"-999"}, {}});
  for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(std::isnan(table.columns[1].values[i])) << i;
  EXPECT_EQ(table.columns[1].values[5], 7);
  EXPECT_EQ(table.columns[1].bad_count, 0U);
}

TEST(TextTable, OtherWordsAreReportedWithTheLocation) {
  const ForeignTable table = table_of("t,x\n0,1\n1,oops\n2,3\n");
  ASSERT_EQ(table.columns[1].bad.size(), 1U);
  EXPECT_EQ(table.columns[1].bad[0].at, (document::Location{3, 3}));
  EXPECT_EQ(table.columns[1].bad[0].text, "oops");
}

TEST(TextTable, TimeOfDayContinuesPastMidnight) {
  const ForeignTable table = table_of("t,x\n23:59:59.5,1\n00:00:00.5,2\n00:00:01.5,3\n");
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(table.columns[0].moments, 3U);
}

/// Returns the table of the columns Date, Time and x. Each row is a date and a time, with a comma between
/// them.
std::string dated(const std::vector<std::string>& rows) {
  std::string text = "Date,Time,x\n";
  for (const std::string& row : rows) text += row + ",1\n";
  return text;
}

TEST(TextTable, DateAndTimeOfDayAreCombined) {
  for (const auto& [first, second] :
       {std::pair("2024-05-31", "2024-06-01"), std::pair("31.05.2024", "01.06.2024"),
        std::pair("31-May-2024", "1-Jun-2024"),
        std::pair("2024-05-31T00:00:00.000000", "2024-06-01T00:00:00.000000")}) {
    const std::string a = std::string(first) + ",";
    const std::string b = std::string(second) + ",";
    const ForeignTable table = table_of(
        dated({a + "23:00:00", a + "23:59:59", b + "00:00:01", ",00:00:02", b + "", b + "23:30:00.5"}));
    EXPECT_EQ(table.columns[1].values[2], 3601) << first;
    EXPECT_EQ(table.columns[1].values[3], 3602) << first;
    EXPECT_EQ(table.columns[1].values[5], 86400 + 1800.5) << first << ": no midnight between two equal dates";
    EXPECT_TRUE(table.columns[0].is_part_of_time);
    EXPECT_EQ(table.columns[0].bad_count, 0U);
    EXPECT_EQ(table.columns[0].moments, 0U);
    EXPECT_EQ(table.notes, std::vector<std::string>{"'Date' and 'Time' are combined into one time"});
    EXPECT_EQ(table_of(dated({a + "10:00:00", b + "10:00:01"})).columns[1].values[1], 86401) << first;
  }
  EXPECT_EQ(table_of(dated({"2024-05-31,23:59:59", "2024-05-31,00:00:01", "2024-05-31,00:00:03"}))
                .columns[1]
                .values[1],
            2)
      << "the date of the start in each row";
  EXPECT_EQ(table_of("Date,x\n2024-05-31 00:00:00,1\n2024-05-31 00:00:01,2\n").columns[0].values[1], 1)
      << "no time of day in another column";
}

TEST(TextTable, DatesThatDoNotChangeAtMidnightAreNotUsed) {
  const std::string before = "2024-05-31,", after = "2024-06-01,";
  for (const auto& [second, third] : {std::pair(before, before), std::pair(after, after)}) {
    const ForeignTable table =
        table_of(dated({before + "23:59:57", second + "23:59:59", third + "00:00:01", after + "00:00:03"}));
    EXPECT_EQ(table.columns[1].values, (std::vector<double>{0, 2, 4, 6}));
    EXPECT_TRUE(table.columns[0].is_part_of_time);
    EXPECT_EQ(
        table.notes,
        (std::vector<std::string>{
            "the clock overflows at midnight, 1 time, first in line 4 of 'Time', and the times after each "
            "overflow are corrected",
            "'Date' does not change in the row in which 'Time' passes midnight, so the dates are not "
            "used"}));
  }
}

TEST(TextTable, ChangeOfAnUnreadableDateIsRefusedExceptAtMidnight) {
  EXPECT_NE(
      refusal(dated({"05/31/2024,10:00:00", "06/01/2024,10:00:01"})).find("t.csv:3:1: the date changes"),
      std::string::npos);
  const ForeignTable table =
      table_of(dated({"05/31/2024,23:59:59", "06/01/2024,00:00:01", "06/01/2024,00:00:03"}));
  EXPECT_EQ(table.columns[1].values[1], 2);
  EXPECT_EQ(table.columns[0].bad_count, 3U);
  EXPECT_FALSE(table.columns[0].is_part_of_time);
}

TEST(TextTable, OnlyTheLastLineMayBeTruncated) {
  EXPECT_EQ(table_of("t,x\n0,1\n1,2\n2").warnings,
            std::vector<std::string>{"line 4: the last line is cut off and left out"});
  EXPECT_NE(refusal("t,x\n0,1\n1\n2,3\n3,4\n").find("t.csv:3:1: 1 cells, but the rows above have 2"),
            std::string::npos);
}

TEST(TextTable, NamesOfASecondTableAreRefused) {
  TableOptions skip;
  skip.skip_bad_lines = true;
  const std::string begin = "t,set,tip\n[s],[kPa],[mm]\n0,1,5\n1,2,6\n";
  for (const char* names : {"t,tip,set", "a,b,c", "t,tip", "[s],[psi],[mm]", ",set,t", "t,set,tip,flow"}) {
    for (const TableOptions& options : {TableOptions{}, skip}) {
      const std::string said = refusal(begin + names + "\n2,7,3\n3,8,4\n", options);
      EXPECT_NE(said.find("t.csv:5:1: a second table begins here"), std::string::npos) << names << said;
      EXPECT_NE(said.find("split the file before this line"), std::string::npos) << said;
    }
  }
  document::Problems problems;
  EXPECT_FALSE(parse_text_table("t.csv", "# t x\n0 1\n1 2\n# x t\n2 3\n3 4\n", {}, problems));
  ASSERT_EQ(problems.size(), 1U) << problems.format();
  EXPECT_NE(problems.format().find("t.csv:4:1: a second table"), std::string::npos);
}

TEST(TextTable, RepeatedNamesAndOtherWordsAreBadLines) {
  TableOptions skip;
  skip.skip_bad_lines = true;
  skip.missing = {"over"};
  const ForeignTable table = table_of(
      "t,set,tip\n[s],[kPa],[mm]\n0,1,5\n1,2,6\nt,set,tip\n[s],[kPa],[mm]\nerr,err,err\nTest,stopped\n2,over,"
      "lost\n"
      "3,2,7\n",
      skip);
  EXPECT_EQ(table.columns[0].bad_rows, (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_EQ(table.account.left_out[static_cast<std::size_t>(LeftOut::bad_line)], 1U);
  EXPECT_EQ(table_of("# t x\n0 1\n1 2\n# t x\n# a pause\n2 3\n").columns[1].values.size(), 3U);
}

TEST(TextTable, AShortLastCellWithoutALineBreakIsAWarning) {
  const std::string rows = "t,x\n0,10.5\n1,12.5\n2,";
  const auto warnings = table_of(rows + "1").warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].find("line 4: the last row may be cut off"), 0U) << warnings[0];
  EXPECT_EQ(table_of(rows).warnings.size(), 1U);
  EXPECT_EQ(table_of(rows + "1").columns[1].values.back(), 1);
  for (const char* whole : {"1\n", "1\r\n", "13.5", "1\n# end"})
    EXPECT_TRUE(table_of(rows + whole).warnings.empty()) << whole;
}

TEST(TextTable, RowsAreSelectedByChannel) {
  const std::string text = "t,channel,x\n0,left,1\n0,right,2\n1,left,3\n1,right,4\n";
  EXPECT_EQ(table_of(text).channels, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(table_of(text, {0, {}, "right"}).columns[2].values, (std::vector<double>{2, 4}));
}

TEST(TextTable, TextWithoutATableIsRefused) {
  EXPECT_NE(refusal("").find("the file is empty"), std::string::npos);
  EXPECT_NE(refusal("hello\nworld\n").find("no rows of numbers"), std::string::npos);
  EXPECT_NE(refusal(std::string("a\0b", 3)).find("not a text"), std::string::npos);
}

TEST(CellValue, ThousandsSeparatorsAreRejected) {
  for (const char* cell : {"1.234,5", "1,234.5", "1,234,567", "1,", ",5x", "0x1p3z"})
    EXPECT_EQ(cell_value(cell, {}).kind, CellKind::text) << cell;
  EXPECT_EQ(cell_value(" \"-1,5e3\" ", {}).number, -1500);
}

TEST(TextTable, CellsWithAmbiguousCommasAreNamed) {
  const ForeignTable table = table_of("t,x,y\n1,\"20,000\",\"0,5\"\n2,467,3\n");
  EXPECT_EQ(table.columns[0].ambiguous_mark, "");
  EXPECT_EQ(table.columns[1].ambiguous_mark, "20,000");
  EXPECT_EQ(table.columns[2].ambiguous_mark, "");
}

TEST(TextTable, CommasInTextsAndTimesAreNoDecimalCommas) {
  const ForeignTable table = table_of(
      "time;x;note\n2024-05-31 12:00:00,000;0.5;a\n2024-05-31 12:00:00,250;1.5;\"step 1,5\"\n"
      "2024-05-31 12:00:00,500;2.5;b\n");
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.format, "text, ';' between columns");
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{0, 0.25, 0.5}));
  EXPECT_EQ(table.columns[1].values, (std::vector<double>{0.5, 1.5, 2.5}));
}

TEST(TextTable, ASeparatorWithoutCellsOfTextIsPreferred) {
  for (const char* separator : {";", " ", "\t"}) {
    const std::string s = separator;
    const ForeignTable table = table_of("p" + s + "x\n0,5" + s + "1,25\n1,5" + s + "2,25\n");
    ASSERT_EQ(table.columns.size(), 2U) << "'" << s << "'";
    EXPECT_EQ(table.columns[1].values, (std::vector<double>{1.25, 2.25}));
  }
}

TEST(TextEncoding, EncodingsAreConvertedToUtf8) {
  EXPECT_EQ(utf8_of("\xef\xbb\xbf"
                    "a"),
            "a");
  EXPECT_EQ(utf8_of(std::string_view("\xff\xfe\xb5\0m\0", 6)), "\xc2\xb5m");
  EXPECT_EQ(utf8_of(std::string_view("\xfe\xff\0\xb5\0m", 6)), "\xc2\xb5m");
  EXPECT_EQ(utf8_of("\xb5m"), "\xc2\xb5m");
  EXPECT_EQ(utf8_of("\xc2\xb5m"), "\xc2\xb5m");
  EXPECT_EQ(utf8_of("1\r2\r"), "1\n2\n");
}

TEST(TextEncoding, Utf16WithoutAByteOrderMarkIsRecognised) {
  const std::string text = "time_s,pressure_kpa,tip_\xb5m\n0,1,2\n0.01,2,3\n";
  std::string little;
  std::string big;
  for (const char c : text) {
    little += {c, '\0'};
    big += {'\0', c};
  }
  for (const std::string& bytes : {little, big}) {
    const ForeignTable table = table_of(bytes);
    ASSERT_EQ(table.columns.size(), 3U);
    EXPECT_EQ(table.columns[2].name, "tip_\xc2\xb5m");
    EXPECT_EQ(table.columns[2].values, (std::vector<double>{2, 3}));
    EXPECT_TRUE(table.notes.empty());
  }
  little.replace(0, 2, "\xa9\x03");
  EXPECT_EQ(table_of(little).columns[0].name, "\xce\xa9ime_s");
  EXPECT_FALSE(utf8_of(std::string(80, '\0')));
  EXPECT_FALSE(utf8_of(little.substr(0, 40) + std::string(60, 'x')));
}

TEST(TextTable, TooManyLinesAreRefusedBeforeSplitting) {
  std::string text = "time_s,tip\n";
  text.reserve(text.size() + 4 * (most_rows + 1));
  for (std::size_t i = 0; i <= most_rows; ++i) text += "1,2\n";
  document::Problems problems;
  EXPECT_FALSE(parse_text_table("f.csv", text, {}, problems));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.list().front().message, "the text has more than 16777216 lines");
}

TEST(TextTable, GivenSeparatorOverridesDetection) {
  const std::string text = "0,1;2,3\n0,2;2,4\n0,3;2,5\n";
  TableOptions options;
  options.separator = ',';
  EXPECT_EQ(table_of(text, options).columns.size(), 3U);
  options.separator = ';';
  const ForeignTable table = table_of(text, options);
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[0].values, (std::vector<double>{0.1, 0.2, 0.3}));
}

TEST(TextTable, RefusesALineThatIsTooLong) {
  document::Problems problems;
  const std::string text = "t_s,p_kpa\n0,1\n" + std::string(longest_line + 1, ',') + "\n1,2\n";
  EXPECT_FALSE(parse_text_table("t.csv", text, {}, problems));
  EXPECT_EQ(problems.list().front().message, "line 3 has more than 1048576 bytes");
}

TEST(WholeNumber, AcceptsOnlyDecimalDigits) {
  EXPECT_EQ(whole_number("0"), 0U);
  EXPECT_EQ(whole_number("1048576"), 1048576U);
  for (const char* none : {"", "-1", "+1", "1.0", " 1", "1 ", "B7", "1e3", "99999999999999999999999"})
    EXPECT_FALSE(whole_number(none)) << none;
}

}  // namespace
}  // namespace softgrip::sysid::text_table_test
