// Generates files in many dialects, with different clocks and with damage. The import must report the use of
// each row, column and option.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "sysid/import/conversion.h"
#include "sysid/import/proposal.h"
#include "sysid/import/table_readers.h"

namespace softgrip::sysid::import_account_test {
namespace {

constexpr int files = 400;
constexpr std::int64_t step_ms = 20;

enum class Clock { seconds, milliseconds, counter_16_bit, epoch, of_day, half_days, minutes, colons, count };

std::string padded(std::int64_t value, int digits) {
  std::string text = std::to_string(value);
  while (static_cast<int>(text.size()) < digits) text.insert(0, "0");
  return text;
}

std::string clock_text(Clock clock, std::int64_t ms) {
  const std::int64_t of_day_ms = (ms + 86'395'000) % 86'400'000;
  const std::int64_t hours = of_day_ms / 3'600'000;
  const std::string minutes = padded(of_day_ms / 60'000 % 60, 2);
  const std::string second = padded(of_day_ms / 1000 % 60, 2);
  const std::string fraction = padded(of_day_ms % 1000, 3);
  switch (clock) {
    case Clock::seconds:
      return fixed(static_cast<double>(ms) / 1000, 3);
    case Clock::milliseconds:
      return std::to_string(ms);
    case Clock::counter_16_bit:
      return std::to_string((ms + 64'000) % 65'536);
    case Clock::epoch:
      return fixed(1'717'156'800 + static_cast<double>(ms) / 1000, 3);
    case Clock::of_day:
      return padded(hours, 2) + ":" + minutes + ":" + second + "." + fraction;
    case Clock::half_days:
      return padded((hours + 11) % 12 + 1, 2) + ":" + minutes + ":" + second + "." + fraction +
             (hours < 12 ? " AM" : " PM");
    case Clock::minutes:
      return minutes + ":" + second + "." + fraction;
    default:
      return padded(hours, 2) + ":" + minutes + ":" + second + ":" + fraction;
  }
}

std::string clock_name(Clock clock) {
  if (clock == Clock::seconds) return "time_s";
  if (clock == Clock::milliseconds || clock == Clock::counter_16_bit) return "t_ms";
  return clock == Clock::epoch ? "timestamp" : "Time";
}

/// A generated file and the expected result of its import.
struct Generated {
  std::string text;
  std::string about;
  Mapping mapping;
  std::size_t rows = 0;
  std::map<LeftOut, std::size_t> left_out;
  std::size_t joined = 0;
  std::map<std::int64_t, double> readings;  ///< expected readings by time [ms]; the log must have a reading
                                            ///< at each of these times
  std::map<std::int64_t, double> commands;  ///< commands of the file by time [ms]
  std::vector<std::string> unused;
  std::vector<std::string> second_times;  ///< unused columns whose values look like times
  std::vector<std::string> idle;
};

class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  Generated make() {
    separator_ = std::string(",;\t|")[pick(4)];
    comma_ = separator_ != ',' && one_in(3);
    clock_ = static_cast<Clock>(pick(static_cast<std::size_t>(Clock::count)));
    file_.about = std::string("separator '") + separator_ + "', clock " +
                  std::to_string(static_cast<int>(clock_)) + (comma_ ? ", decimal comma" : "");
    second_time_ = one_in(4) && clock_ == Clock::milliseconds;
    raw_ = one_in(3);
    commands_alone_ = one_in(3);
    file_.mapping.skip_bad_lines = one_in(3);
    header();
    const int rows = 120 + static_cast<int>(pick(200));
    for (int i = 0; i < rows; ++i) row(i);
    ending();
    idle_options();
    return file_;
  }

 private:
  std::size_t pick(std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random_);
  }
  bool one_in(std::size_t n) { return pick(n) == 0; }

  void line(const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      file_.text += (i == 0 ? "" : std::string(1, separator_)) + cells[i];
    file_.text += "\n";
  }

  std::string number(double value) const {
    std::string text = fixed(value, 4);
    if (comma_) std::replace(text.begin(), text.end(), '.', ',');
    return text;
  }

  void header() {
    if (one_in(4)) file_.text += "# made by a generator\n";
    std::vector<std::string> names{clock_name(clock_), "set_kpa", "tip_mm"};
    if (raw_) names.emplace_back("valve_current_mA");
    if (second_time_) {
      names.emplace_back("clock_s");
      file_.second_times.push_back(names.back());
    }
    for (std::size_t i = 3; i < names.size(); ++i) file_.unused.push_back(names[i]);
    line(names);
  }

  void row(int i) {
    const std::int64_t ms = step_ms * i;
    const double command = 30 - std::abs(i % 100 - 50) * 0.6;
    const double reading = std::round(1e4 * (0.2 * command + 0.001 * i)) / 1e4;
    const bool has_command = i == 0 || !commands_alone_ || i % 7 == 0;
    const bool has_reading = i == 0 || !commands_alone_ || i % 7 != 0;
    std::string time = clock_text(clock_, ms);
    if (comma_ && (clock_ == Clock::seconds || clock_ == Clock::epoch))
      std::replace(time.begin(), time.end(), '.', ',');
    std::vector<std::string> cells{time, has_command ? number(command) : "",
                                   has_reading ? number(reading) : ""};
    if (raw_) cells.push_back(number(4 + 0.1 * command));
    if (second_time_) cells.push_back(number(static_cast<double>(ms) / 1000));
    damage(i, ms, cells, has_command ? command : std::nan(""), has_reading ? reading : std::nan(""));
  }

  void keep(std::int64_t ms, double command, double reading) {
    if (std::isfinite(command)) file_.commands[ms] = command;
    if (std::isfinite(reading)) file_.readings[ms] = reading;
  }

  void damage(int i, std::int64_t ms, std::vector<std::string> cells, double command, double reading) {
    ++file_.rows;
    const std::size_t kind = i < 5 ? 99 : pick(150);
    if (kind == 0) {
      cells[0].clear();
      ++file_.left_out[LeftOut::no_time];
    } else if (kind == 1 && file_.mapping.skip_bad_lines) {
      cells.emplace_back("1");
      ++file_.left_out[LeftOut::bad_line];
    } else if (kind == 2 && file_.mapping.skip_bad_lines) {
      cells[1] = "oops";
      ++file_.left_out[LeftOut::bad_line];
    } else if (kind == 3 && std::isfinite(command) && std::isfinite(reading)) {
      keep(ms, command, reading);
      line(cells);
      ++file_.rows;
      ++file_.left_out[LeftOut::repeated_time];
    } else if (kind == 4 && std::isfinite(command) && std::isfinite(reading)) {
      keep(ms, command, reading);
      std::vector<std::string> first = cells;
      first[2].clear();
      cells[1].clear();
      line(first);
      ++file_.rows;
      ++file_.joined;
    } else {
      if (kind == 5) {
        file_.text += "\n# a remark\n";
        ++file_.rows;
        ++file_.left_out[LeftOut::empty];
      }
      keep(ms, command, reading);
    }
    line(cells);
  }

  void ending() {
    if (one_in(5)) {
      file_.text += clock_text(clock_, step_ms * 1000);
      ++file_.rows;
      ++file_.left_out[LeftOut::cut_off_line];
    } else if (one_in(5)) {
      file_.text += std::string(64, '\0');
    }
  }

  void idle_options() {
    if (one_in(3)) {
      file_.mapping[Role::supply].unit = "bar";
      file_.idle.emplace_back("--unit supply=bar");
    }
    if (one_in(3)) {
      file_.mapping.missing = {"888"};
      file_.idle.emplace_back("--missing 888");
    }
    if (one_in(3)) {
      file_.mapping[Role::time].zero_first = true;
      file_.idle.emplace_back("--zero time=first");
    }
    if (one_in(3)) {
      file_.mapping.to_s = 1e6;
      file_.idle.emplace_back("--from-s or --to-s");
    }
  }

  std::mt19937 random_;
  Generated file_;
  char separator_ = ',';
  bool comma_ = false;
  bool second_time_ = false;
  bool raw_ = false;
  bool commands_alone_ = false;
  Clock clock_ = Clock::seconds;
};

bool any_says(const std::vector<std::string>& sentences, const std::string& text) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& sentence) { return sentence.find(text) != std::string::npos; });
}

void check_rows(const Generated& file, const ImportedLog& result) {
  EXPECT_EQ(result.account.rows, file.rows);
  EXPECT_EQ(result.account.used, result.log.size());
  EXPECT_EQ(result.account.joined, file.joined);
  std::size_t sum = result.account.used + result.account.joined;
  for (std::size_t i = 0; i < left_out_count; ++i) {
    const auto reason = static_cast<LeftOut>(i);
    const auto expected = file.left_out.find(reason);
    EXPECT_EQ(result.account.left_out[i], expected == file.left_out.end() ? 0 : expected->second)
        << word_of(reason);
    sum += result.account.left_out[i];
  }
  EXPECT_EQ(sum, file.rows);
}

/// Checks that the log has every value of the file at the correct time. Exceptions are the values that the
/// import reports as omitted.
void check_values(const Generated& file, const Log& log) {
  std::size_t readings = 0;
  double held = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const std::int64_t ms = std::llround(1000 * log.time_s[i]);
    const auto command = file.commands.find(ms);
    if (command != file.commands.end()) held = command->second;
    EXPECT_NEAR(log.pressure_command_kpa[i], held, 1e-9) << ms;
    if (!std::isfinite(log.displacement_mm[i])) continue;
    ++readings;
    const auto reading = file.readings.find(ms);
    ASSERT_NE(reading, file.readings.end()) << ms;
    EXPECT_NEAR(log.displacement_mm[i], reading->second, 1e-9) << ms;
  }
  EXPECT_EQ(readings, file.readings.size());
}

TEST(ImportAccount, EveryRowColumnAndOptionIsAccountedFor) {
  for (unsigned seed = 0; seed < files && !HasFailure(); ++seed) {
    const Generated file = Generator(seed).make();
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + file.about);
    document::Problems problems;
    TableOptions options;
    options.skip_bad_lines = file.mapping.skip_bad_lines;
    const auto table = parse_text_table("t.csv", file.text, options, problems);
    ASSERT_TRUE(table) << problems.format();
    const auto result = convert(*table, propose(*table, file.mapping, true).mapping, problems);
    ASSERT_TRUE(result) << problems.format() << file.text.substr(0, 500);
    check_rows(file, *result);
    check_values(file, result->log);
    for (const std::string& column : file.unused)
      EXPECT_TRUE(any_says(result->notes, "'" + column + "'")) << column;
    for (const std::string& column : file.second_times)
      EXPECT_TRUE(any_says(result->notes, "'" + column + "' looks like a time") ||
                  any_says(result->warnings, "'" + column + "' looks like a time"))
          << column;
    for (const std::string& option : file.idle)
      EXPECT_TRUE(any_says(result->warnings, option + " has no effect")) << option;
  }
}

/// If the import cannot read a time with certainty, it must refuse the file and state the line. It must not
/// return a shorter log.
TEST(ImportAccount, AClockThatIsSetBackIsRefused) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    const int at = std::uniform_int_distribution<int>(10, 180)(random);
    const int back = std::uniform_int_distribution<int>(2, 9)(random);
    std::string text = "time_s,set_kpa,tip_mm\n";
    for (int i = 0; i < 200; ++i)
      text += fixed(0.02 * (i < at ? i : i - back), 3) + "," + std::to_string(i % 50) + "," +
              std::to_string(i % 40) + "\n";
    document::Problems problems;
    const auto table = parse_text_table("t.csv", text, {}, problems);
    ASSERT_TRUE(table);
    EXPECT_FALSE(convert(*table, propose(*table, {}, true).mapping, problems));
    EXPECT_NE(problems.format().find("t.csv:" + std::to_string(at + 2) + ":1: the time goes back"),
              std::string::npos)
        << problems.format();
  }
}

}  // namespace
}  // namespace softgrip::sysid::import_account_test
