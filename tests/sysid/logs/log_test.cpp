#include "sysid/logs/log.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>

#include "base/files.h"
#include "base/numbers.h"

namespace softgrip::sysid::log_test {
namespace {

using document::Problems;

/// Returns a valid log with 100 samples of one slow triangle. The hysteresis in the log is so large that the
/// log looks like a log of a real finger.
Log good_log() {
  Log log;
  for (int i = 0; i < 100; ++i) {
    log.time_s.push_back(0.01 * i);
    log.pressure_command_kpa.push_back(i < 50 ? i : 99 - i);
    log.displacement_mm.push_back(0.25 * (i < 50 ? i : 99 - i) + (i < 50 ? 0.0 : 1.0) + 0.001 * (i % 7));
  }
  return log;
}

std::string good_text() {
  return format_log(good_log());
}

/// Returns the text of the valid log, with line `number` replaced by `line`. The first line has the number 1.
std::string with_line(int number, const std::string& line) {
  std::string text = good_text();
  std::size_t begin = 0;
  for (int i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
  return text.replace(begin, text.find('\n', begin) - begin, line);
}

LogOptions channel_named(const std::string& channel) {
  LogOptions options;
  options.channel = channel;
  return options;
}

struct Bad {
  std::string name;
  std::string text;
  int line;             ///< expected line of the first problem
  int column;           ///< expected column of the first problem
  std::string message;  ///< text that the message must contain
  std::string hint;     ///< text that the hint must contain
  LogOptions options = {};
};

std::ostream& operator<<(std::ostream& out, const Bad& bad) {
  return out << bad.name;
}

std::string with_log(void (*change)(Log&)) {
  Log log = good_log();
  change(log);
  return format_log(log);
}

std::vector<Bad> bad_logs() {
  const std::string header = "time_s,pressure_command_kpa,displacement_mm";
  return {
      {"Empty", "", 1, 1, "empty", ""},
      {"Binary", std::string("time_s\0,", 8), 1, 1, "byte 0", ""},
      {"NoHeader", good_text().substr(good_text().find('\n') + 1), 1, 1, "numbers instead of column names",
       "time_s,pressure_command_kpa"},
      {"MissingColumn", with_line(1, "time_s,pressure_command_kpa,displacment_mm"), 1, 1,
       "'displacement_mm' is missing", "displacment_mm"},
      {"WrongUnit", with_line(1, "time_s,pressure_command_bar,displacement_mm"), 1, 8, "wrong unit",
       "'pressure_command_kpa', multiply by 100"},
      {"NoUnit", with_line(1, "time,pressure_command_kpa,displacement_mm"), 1, 1, "has no unit", "'time_s'"},
      {"ColumnTwice", with_line(1, "time_s,pressure_command_kpa,time_s"), 1, 29, "occurs twice", ""},
      {"Semicolons", with_line(1, "time_s;pressure_command_kpa;displacement_mm"), 1, 7, "separated by ';'",
       "','"},
      {"Tabs", with_line(1, "time_s\tpressure_command_kpa\tdisplacement_mm"), 1, 7, "tabs", "','"},
      {"DecimalComma", with_line(3, "0,01,1,0,0,251"), 3, 1, "6 cells, but the header has 3",
       "decimal comma"},
      {"RowTooShort", with_line(7, "0.05,5"), 7, 1, "2 cells", ""},
      {"NotANumber", with_line(5, "0.03,three,0.75"), 5, 6, "'three' in column 'pressure_command_kpa'", ""},
      {"NaN", with_line(9, "0.07,7,nan"), 9, 8, "'nan' in column 'displacement_mm'", "leave the cell empty"},
      {"Infinite", with_line(9, "0.07,-inf,1.5"), 9, 6, "'-inf'", ""},
      {"EmptyCommand", with_line(9, "0.07,,1.5"), 9, 6, "no number in column 'pressure_command_kpa'", ""},
      {"TimeGoesBack", with_line(20, "0.01,18,4.5"), 20, 1, "goes back from 0.17 s to 0.01 s", ""},
      {"TimeStands", with_line(20, "0.17,18,4.5"), 20, 1, "0.17 s occurs twice", ""},
      {"TwoRunsInOneFile", good_text() + good_text().substr(good_text().find('\n') + 1), 102, 1, "goes back",
       "two runs"},
      {"TimeFromElsewhere", with_log([](Log& log) {
         for (double& t : log.time_s) t += 1700000;
       }),
       2, 1, "starts at", "subtract"},
      {"TimeInMilliseconds", with_log([](Log& log) {
         for (double& t : log.time_s) t *= 1e5;
       }),
       2, 1, "1000 s apart", "milliseconds"},
      {"Hole", with_log([](Log& log) {
         for (std::size_t i = 30; i < 100; ++i) log.time_s[i] += 2;
       }),
       32, 1, "a gap of 2.01 s", "two logs"},
      {"Short", format_log(slice(good_log(), 0, 12)), 13, 1, "12 samples", "at least 50"},
      {"Pascal", with_log([](Log& log) {
         for (double& p : log.pressure_command_kpa) p *= 1000;
       }),
       51, 8, "kPa; the permitted magnitude is at most 5000 kPa", "Pa"},
      {"Micrometres", with_log([](Log& log) {
         for (double& y : log.displacement_mm) y *= 1000;
       }),
       52, 29, "mm; the permitted magnitude is at most 5000 mm", "micrometres"},
      {"CommandConstant", with_log([](Log& log) {
         for (double& p : log.pressure_command_kpa) p = 20;
       }),
       2, 8, "20 kPa from start to end", "the pressure changes"},
      {"SensorDead", with_log([](Log& log) {
         for (double& y : log.displacement_mm) y = 3;
       }),
       2, 29, "never changes", "connected"},
      {"SensorClips", with_log([](Log& log) {
         for (double& y : log.displacement_mm) y = std::min(y, 8.0);
       }),
       34, 29, "extreme value 8 mm", "saturates"},
      {"ReadingsMissing", with_log([](Log& log) {
         for (std::size_t i = 40; i < 91; ++i) log.displacement_mm[i] = std::nan("");
       }),
       42, 29, "51.0 % of the samples have no reading", "at least 50 readings"},
      {"SeveralChannels", header + ",channel\n0,0,0,left\n0,0,0,right\n", 1, 1, "2 channels: 'left', 'right'",
       "--channel"},
      {"NoSuchChannel", header + ",channel\n0,0,0,left\n", 1, 1, "no channel 'thumb'", "",
       channel_named("thumb")},
      {"ChannelOfAPlainLog", good_text(), 1, 1, "no column 'channel'", "", channel_named("left")},
  };
}

class BadLog : public ::testing::TestWithParam<Bad> {};

TEST_P(BadLog, IsRefusedWithFileLineAndColumn) {
  const Bad& bad = GetParam();
  Problems problems;
  EXPECT_FALSE(parse_log("bad.csv", bad.text, problems, bad.options));
  ASSERT_FALSE(problems.empty());
  const auto& first = problems.list().front();
  EXPECT_EQ(first.file, "bad.csv");
  EXPECT_EQ(first.at.line, bad.line) << first.message;
  EXPECT_EQ(first.at.column, bad.column) << first.message;
  EXPECT_NE(first.message.find(bad.message), std::string::npos) << first.message;
  EXPECT_NE(first.hint.find(bad.hint), std::string::npos) << first.hint;
}

INSTANTIATE_TEST_SUITE_P(Kinds, BadLog, testing::ValuesIn(bad_logs()),
                         [](const auto& bad) { return bad.param.name; });

TEST(Log, ValidLogIsReadWithoutNotes) {
  Problems problems;
  const auto log = parse_log("dir/good.csv", good_text(), problems);
  ASSERT_TRUE(log) << problems.format();
  EXPECT_EQ(log->size(), 100U);
  EXPECT_EQ(log->name, "good");
  EXPECT_EQ(log->displacement_mm, good_log().displacement_mm);
  EXPECT_EQ(log->sha256.size(), 64U);
  EXPECT_TRUE(log->notes.empty()) << log->notes.front().text;
}

TEST(Log, LogOfASlowProcessIsRead) {
  Log slow = good_log();
  for (double& t : slow.time_s) t *= 6000;
  document::Problems problems;
  EXPECT_TRUE(parse_log("slow.csv", format_log(slow), problems));
}

TEST(Log, FormattedLogIsParsedWithoutLoss) {
  Log log = good_log();
  log.time_s[1] = 0.1 / 3 * 0.2;
  log.temperature_c.assign(100, 1.0 / 3);
  log.supply_kpa.assign(100, 612.5);
  log.pressure_kpa.assign(100, 2.0 / 7);
  log.displacement_mm[10] = std::nan("");
  log.channel = "left";
  log.others = {{"phase", std::vector<std::string>(100, "hold, long")}};
  Problems problems;
  const auto back = parse_log("log.csv", format_log(log), problems);
  ASSERT_TRUE(back) << problems.format();
  EXPECT_EQ(back->time_s, log.time_s);
  EXPECT_EQ(back->pressure_kpa, log.pressure_kpa);
  EXPECT_EQ(back->temperature_c, log.temperature_c);
  EXPECT_EQ(back->supply_kpa, log.supply_kpa);
  EXPECT_EQ(back->others, log.others);
  EXPECT_TRUE(std::isnan(back->displacement_mm[10]));
  EXPECT_EQ(format_log(*back), format_log(log));
}

TEST(Log, AnOptionalColumnWithFewerThanTwoValuesIsMissing) {
  for (const std::size_t values : {0U, 1U, 2U}) {
    Log log = good_log();
    log.pressure_kpa.assign(100, std::nan(""));
    for (std::size_t i = 0; i < values; ++i) log.pressure_kpa[40 * (i + 1)] = 3;
    Problems problems;
    const auto back = parse_log("log.csv", format_log(log), problems);
    ASSERT_TRUE(back) << problems.format();
    EXPECT_EQ(back->pressure_kpa.empty(), values < 2);
    const bool noted = std::ranges::any_of(back->notes, [](const LogNote& note) {
      return note.corrects && note.text.find("pressure_kpa has fewer than two values") != std::string::npos;
    });
    EXPECT_EQ(noted, values < 2);
  }
}

TEST(UniqueName, DiffersFromAllEarlierNames) {
  std::set<std::string> used;
  for (const auto& [name, unique] :
       {std::pair("run", "run"), std::pair("run (2)", "run (2)"), std::pair("run", "run (3)"),
        std::pair("run", "run (4)"), std::pair("run (2)", "run (2) (2)")})
    EXPECT_EQ(unique_name(name, used), unique);
}

/// Returns a log text. The column of the readings has the name `name`.
std::string with_readings_called(const std::string& name, std::string text) {
  const std::string usual = "displacement_mm";
  return text.replace(text.find(usual), usual.size(), name);
}

TEST(Log, AngleInDegreesIsReadWithoutConversion) {
  Problems problems;
  const auto log = parse_log("a.csv", with_readings_called("angle_deg", good_text()), problems);
  ASSERT_TRUE(log) << problems.format();
  EXPECT_EQ(log->output_unit, model::OutputUnit::deg);
  EXPECT_EQ(log->displacement_mm, good_log().displacement_mm);
  EXPECT_TRUE(log->others.empty());
  EXPECT_EQ(format_log(*log), with_readings_called("angle_deg", good_text()));
}

TEST(Log, AnAngleInRadiansIsConvertedOnce) {
  Problems problems;
  Log radians = good_log();
  for (double& y : radians.displacement_mm) y *= std::numbers::pi / 180;
  const auto log = parse_log("a.csv", with_readings_called("angle_rad", format_log(radians)), problems);
  ASSERT_TRUE(log) << problems.format();
  EXPECT_EQ(log->output_unit, model::OutputUnit::deg);
  for (std::size_t i = 0; i < log->size(); ++i)
    EXPECT_NEAR(log->displacement_mm[i], good_log().displacement_mm[i], 1e-13);
  const auto again = parse_log("b.csv", format_log(*log), problems);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->displacement_mm, log->displacement_mm);
}

TEST(Log, AnAngleTooLargeForDegreesIsRefused) {
  Problems problems;
  std::string text = with_readings_called("angle_rad", good_text());
  text += "1,0,1e308\n";
  EXPECT_FALSE(parse_log("a.csv", text, problems));
  EXPECT_NE(problems.format().find("a bending angle of 1e+308 deg"), std::string::npos) << problems.format();
}

TEST(Log, AngleColumnIsSecondaryNextToADisplacement) {
  Problems problems;
  Log log = good_log();
  log.others.push_back({"angle_deg", std::vector<std::string>(log.size(), "7")});
  const auto read = parse_log("a.csv", format_log(log), problems);
  ASSERT_TRUE(read) << problems.format();
  EXPECT_EQ(read->output_unit, model::OutputUnit::mm);
  EXPECT_EQ(read->others, log.others);
}

TEST(Log, MessagesOfAnAngleSayDegrees) {
  Problems problems;
  Log far = good_log();
  for (double& y : far.displacement_mm) y *= 1000;
  EXPECT_FALSE(parse_log("a.csv", with_readings_called("angle_deg", format_log(far)), problems));
  EXPECT_NE(problems.format().find("a bending angle of "), std::string::npos) << problems.format();
  EXPECT_NE(problems.format().find(" deg"), std::string::npos);
  problems = {};
  EXPECT_FALSE(parse_log("a.csv", with_readings_called("angle", good_text()), problems));
  EXPECT_NE(problems.format().find("'angle_deg' or 'angle_rad'"), std::string::npos) << problems.format();
}

TEST(Log, ReadingsInAnUnexpectedUnitAreRefused) {
  Problems problems;
  LogOptions options;
  options.output_unit = model::OutputUnit::deg;
  options.output_unit_of = "the model finger";
  EXPECT_FALSE(parse_log("a.csv", good_text(), problems, options));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.list().front().at.line, 1);
  EXPECT_EQ(problems.list().front().at.column, 29);
  EXPECT_EQ(problems.list().front().message,
            "column 'displacement_mm' gives readings in mm, and the model finger is in deg");
}

TEST(Log, AcceptsAByteOrderMarkAndCrlfLines) {
  std::string text = "\xef\xbb\xbf" + good_text();
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2))
    text.insert(at, "\r");
  Problems problems;
  EXPECT_TRUE(parse_log("good.csv", text, problems)) << problems.format();
}

/// Returns a valid log with an additional column. Each cell of this column contains `cell`, except in the
/// lines that `other` contains with their own cells.
std::string with_column(const std::string& name, const std::string& cell,
                        const std::map<int, std::string>& other = {}) {
  std::istringstream in(good_text());
  std::string text, row;
  for (int line = 1; std::getline(in, row); ++line) {
    const auto found = other.find(line);
    text += row + ',' + (line == 1 ? name : found == other.end() ? cell : found->second) + '\n';
  }
  return text;
}

TEST(Log, QuotedCellsAreWrittenBackUnchanged) {
  const std::string text =
      with_column(R"("note, by ""hand""")", R"("said ""stop"", left")", {{3, R"(a "b" c)"}, {4, R"(" x")"}});
  Problems problems;
  const auto log = parse_log("a.csv", text, problems);
  ASSERT_TRUE(log) << problems.format();
  ASSERT_EQ(log->others.size(), 1U);
  EXPECT_EQ(log->others[0].name, R"(note, by "hand")");
  EXPECT_EQ(log->others[0].cells[0], R"(said "stop", left)");
  EXPECT_EQ(log->others[0].cells[1], R"(a "b" c)");
  EXPECT_EQ(log->others[0].cells[2], " x");
  const auto copy = parse_log("b.csv", format_log(*log), problems);
  ASSERT_TRUE(copy) << problems.format();
  EXPECT_EQ(copy->others, log->others);
}

TEST(Log, UnclosedQuoteIsAnErrorExceptInTheLastRow) {
  Problems problems;
  EXPECT_FALSE(parse_log("a.csv", with_column("note", "b", {{3, "\"b"}}), problems));
  EXPECT_NE(problems.format().find("a.csv:3:1"), std::string::npos) << problems.format();
  EXPECT_NE(problems.format().find("quotation mark is not closed"), std::string::npos);
  Problems none;
  const auto cut = parse_log("a.csv", with_column("note", "b", {{101, "\"b"}}), none);
  ASSERT_TRUE(cut) << none.format();
  EXPECT_EQ(cut->size(), 99U);
}

TEST(Log, TruncatedLastRowIsOmittedWithANote) {
  const std::string text = good_text();
  Problems problems;
  const auto log = parse_log("good.csv", text.substr(0, text.rfind(',')), problems);
  ASSERT_TRUE(log) << problems.format();
  EXPECT_EQ(log->size(), 99U);
  ASSERT_EQ(log->notes.size(), 1U);
  EXPECT_EQ(log->notes.front().line, 101);
}

TEST(Log, IrregularSamplingIsKeptAndNoted) {
  Log irregular = good_log();
  for (std::size_t i = 1; i < 99; i += 2) irregular.time_s[i] += 0.004;
  Problems problems;
  const auto log = parse_log("good.csv", format_log(irregular), problems);
  ASSERT_TRUE(log) << problems.format();
  EXPECT_EQ(log->time_s, irregular.time_s);
  ASSERT_EQ(log->notes.size(), 1U);
  EXPECT_NE(log->notes.front().text.find("irregular"), std::string::npos);
  EXPECT_FALSE(sampling_of(*log).regular);
  EXPECT_TRUE(sampling_of(good_log()).regular);
}

TEST(Log, AGapWithTheCommandAtRestIsOnlyNoted) {
  Log gap = good_log();
  gap.pressure_command_kpa[60] = gap.pressure_command_kpa[59];
  for (std::size_t i = 60; i < 100; ++i) gap.time_s[i] += 1;
  Problems problems;
  const auto log = parse_log("good.csv", format_log(gap), problems);
  ASSERT_TRUE(log) << problems.format();
  ASSERT_FALSE(log->notes.empty());
  EXPECT_EQ(log->notes.front().line, 62);
}

TEST(Log, AllProblemsAreFoundInOnePassAndRepeatedOnesCounted) {
  std::string text = "time_s,pressure_command_kpa,displacement_mm\n";
  for (int i = 0; i < 100; ++i) text += "0.1,x,1\n";
  text += "1,2\n1,2,3\n";
  Problems problems;
  EXPECT_FALSE(parse_log("bad.csv", text, problems));
  ASSERT_EQ(problems.size(), 5U) << problems.format();
  EXPECT_NE(problems.format().find("97 more"), std::string::npos) << problems.format();
}

TEST(Log, AChannelIsTakenOutOfARecording) {
  const Log log = good_log();
  std::string text = "time_s,channel,pressure_command_kpa,displacement_mm\n";
  for (std::size_t i = 0; i < 100; ++i) {
    for (const char* channel : {"left", "right"}) {
      const double factor = channel[0] == 'l' ? 1 : 2;
      text += shortest(log.time_s[i]) + ',' + channel + ',' + shortest(log.pressure_command_kpa[i]) + ',' +
              shortest(factor * log.displacement_mm[i]) + '\n';
    }
  }
  Problems problems;
  const auto right = parse_log("run.csv", text, problems, channel_named("right"));
  ASSERT_TRUE(right) << problems.format();
  EXPECT_EQ(right->name, "run/right");
  EXPECT_DOUBLE_EQ(right->displacement_mm[70], 2 * log.displacement_mm[70]);
}

TEST(Log, FolderIsReadAsARecordedRun) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "softgrip_log_test_run";
  ASSERT_TRUE(write_file((folder / "run.csv").string(), good_text()));
  Problems problems;
  const Campaign campaign = read_campaign({folder.string(), (folder / "absent.csv").string()}, problems);
  std::filesystem::remove_all(folder);
  ASSERT_EQ(campaign.logs.size(), 1U) << problems.format();
  EXPECT_EQ(campaign.logs.front().name, "softgrip_log_test_run");
  EXPECT_TRUE(campaign.unreadable);
  EXPECT_EQ(problems.size(), 1U);
}

TEST(Log, FolderWithoutARunIsNoRecording) {
  const std::string folder = (std::filesystem::path(testing::TempDir()) / "softgrip_log_test_none").string();
  std::filesystem::create_directories(folder);
  Problems problems;
  const Campaign campaign = read_campaign({folder}, problems);
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(campaign.unreadable);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.list().front().file, folder);
  EXPECT_EQ(problems.list().front().message,
            folder + " is not a recording, because this folder contains no run.csv");
}

TEST(Log, ClippingMayBeAllowed) {
  Log log = good_log();
  for (double& y : log.displacement_mm) y = std::min(y, 8.0);
  LogOptions options;
  options.clipped_share_refused = 1;
  Problems problems;
  const auto read = parse_log("clipped.csv", format_log(log), problems, options);
  ASSERT_TRUE(read) << problems.format();
  ASSERT_EQ(read->notes.size(), 1U);
  EXPECT_EQ(read->notes.front().line, 34);
}

TEST(Log, FrozenValuesAreNoted) {
  Log log;
  for (int i = 0; i < 400; ++i) {
    const double p = std::abs(i % 200 - 100);
    log.time_s.push_back(0.02 * i);
    log.pressure_command_kpa.push_back(p);
    log.pressure_kpa.push_back(p + 0.01 * ((i * 7919) % 11));
    log.displacement_mm.push_back(0.2 * p + 0.01 * ((i * 104729) % 13));
  }
  for (std::size_t i = 120; i < 180; ++i) log.displacement_mm[i] = log.displacement_mm[120];
  for (std::size_t i = 220; i < 280; ++i) log.pressure_kpa[i] = log.pressure_kpa[220];
  Problems problems;
  const auto read = parse_log("frozen.csv", format_log(log), problems);
  ASSERT_TRUE(read) << problems.format();
  ASSERT_EQ(read->notes.size(), 2U);
  EXPECT_EQ(read->notes[0].line, 122);
  EXPECT_NE(read->notes[0].text.find("from 2.4 s to 3.58 s, while the command changes by 59 kPa"),
            std::string::npos)
      << read->notes[0].text;
  EXPECT_TRUE(read->notes[1].text.starts_with("the measured pressure remains at exactly "))
      << read->notes[1].text;
}

TEST(Log, AShortLastCellWithoutALineBreakIsNoted) {
  std::string text = "time_s,displacement_mm,pressure_command_kpa\n";
  for (int i = 0; i < 100; ++i)
    text += shortest(0.01 * i) + "," + shortest(0.25 * (i < 50 ? i : 99 - i) + 0.5 * (i % 2)) + "," +
            shortest(100.25 + (i < 50 ? i : 99 - i)) + "\n";
  const auto notes_of = [](const std::string& of) {
    Problems problems;
    const auto read = parse_log("cut.csv", of, problems);
    EXPECT_TRUE(read) << problems.format();
    return read ? read->notes : std::vector<LogNote>{};
  };
  EXPECT_TRUE(notes_of(text).empty());
  EXPECT_TRUE(notes_of(text.substr(0, text.size() - 1)).empty());
  const auto notes = notes_of(text.substr(0, text.size() - 3));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes.front().line, 101);
  EXPECT_EQ(notes.front().text.find("the last row may be cut off"), 0U) << notes.front().text;
}

TEST(Log, ASliceStartsAtZero) {
  const Log part = slice(good_log(), 50, 80);
  EXPECT_EQ(part.size(), 30U);
  EXPECT_EQ(part.time_s.front(), 0);
  EXPECT_EQ(part.pressure_command_kpa.front(), 49);
}

TEST(Log, SameCommandMayHaveAnotherSamplingAndSmallDeviations) {
  const Log log = good_log();
  Log coarse = slice(log, 0, 1);
  for (std::size_t i = 3; i < log.size(); i += 3) {
    coarse.time_s.push_back(log.time_s[i]);
    coarse.pressure_command_kpa.push_back(log.pressure_command_kpa[i]);
  }
  EXPECT_TRUE(have_same_command(log, log, 0.05));
  EXPECT_TRUE(have_same_command(log, coarse, 0.05));
  EXPECT_TRUE(have_same_command(coarse, log, 0.05));
  const auto with_offset = [&](double kpa) {
    Log other = log;
    for (double& p : other.pressure_command_kpa) p += kpa;
    return have_same_command(log, other, 0.05);
  };
  EXPECT_TRUE(with_offset(2));
  EXPECT_FALSE(with_offset(3));
  Log vacuum = log;
  for (double& p : vacuum.pressure_command_kpa) p = -p;
  EXPECT_FALSE(have_same_command(log, vacuum, 0.05));
  EXPECT_FALSE(have_same_command(log, slice(log, 0, 40), 0.05)) << "the shorter log ends at 39 kPa";
}

TEST(MeasuredPressure, IsolatedValuesAreRemovedWithANote) {
  const auto read_with = [](const std::function<void(Log&)>& change) {
    Log log = good_log();
    log.pressure_kpa = log.pressure_command_kpa;
    change(log);
    Problems problems;
    const std::optional<Log> read = parse_log("log.csv", format_log(log), problems);
    EXPECT_TRUE(read) << problems.format();
    return read.value_or(Log{});
  };
  const Log log = read_with([](Log& l) { l.pressure_kpa[30] = 200; });
  EXPECT_TRUE(std::isnan(log.pressure_kpa[30]));
  EXPECT_EQ(log.pressure_kpa[29], 29);
  ASSERT_EQ(log.notes.size(), 1U);
  EXPECT_EQ(log.notes[0].text, "1 of 100 measured pressures is isolated, removed: 200 kPa at 0.3 s");
  EXPECT_EQ(log.notes[0].line, 32);
  const Log pulsed = read_with([](Log& l) { l.pressure_command_kpa[30] = l.pressure_kpa[30] = 90; });
  EXPECT_EQ(pulsed.pressure_kpa[30], 90) << "the pressure follows a pulse of the command";
  EXPECT_TRUE(pulsed.notes.empty());
}

TEST(FirstCommand, WrongFirstCommandIsReplacedWithANote) {
  Log log = good_log();
  std::fill_n(log.pressure_command_kpa.begin(), 25, 0.0);
  std::fill_n(log.displacement_mm.begin(), 25, 0.25);
  log.displacement_mm[3] = 0.251;
  log.pressure_command_kpa[0] = 40;
  Problems problems;
  const std::optional<Log> read = parse_log("log.csv", format_log(log), problems);
  ASSERT_TRUE(read) << problems.format();
  EXPECT_EQ(read->pressure_command_kpa[0], 0);
  ASSERT_FALSE(read->notes.empty());
  EXPECT_EQ(
      read->notes[0].text,
      "the log begins with a command of 40 kPa in 1 sample, but the readings belong to the next command, "
      "0 kPa, which was used instead");
  EXPECT_EQ(read->notes[0].line, 2);
  EXPECT_TRUE(read->notes[0].corrects);
}

TEST(FirstReadings, WrongFirstReadingsAreRemovedWithANote) {
  Log log = good_log();
  std::fill_n(log.displacement_mm.begin(), 2, -7.5);
  Problems problems;
  const std::optional<Log> read = parse_log("log.csv", format_log(log), problems);
  ASSERT_TRUE(read) << problems.format();
  EXPECT_TRUE(std::isnan(read->displacement_mm[0]));
  EXPECT_TRUE(std::isnan(read->displacement_mm[1]));
  EXPECT_EQ(read->displacement_mm[2], log.displacement_mm[2]);
  ASSERT_FALSE(read->notes.empty());
  EXPECT_EQ(read->notes[0].text,
            "the first 2 readings were removed: the jump from -7.5 to 0.502 mm has no cause in the pressure");
  EXPECT_EQ(read->notes[0].line, 2);
  EXPECT_TRUE(read->notes[0].corrects);
}

}  // namespace
}  // namespace softgrip::sysid::log_test
