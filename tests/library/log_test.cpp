#include "library/include/softgrip/log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "library/include/softgrip/error.h"
#include "tests/library/finger.h"

namespace softgrip::log_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Log simulated() {
  const Course course = sine(0, 40, 0.1, 400, 0.05);
  Log log;
  log.name = "sine";
  log.time_s = course.time_s;
  log.pressure_command_kpa = course.value;
  log.displacement = bench_twin().simulate(course.time_s, course.value, {.noise = 0.05});
  return log;
}

class LibraryLog : public testing::Test {
 protected:
  LibraryLog() { std::filesystem::create_directories(folder_); }
  ~LibraryLog() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text = "") {
    const std::string path = (folder_ / name).string();
    if (!text.empty()) std::ofstream(path) << text;
    return path;
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      ("library_log_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

/// Makes a change to a valid log. Returns the message with which check() refuses the changed log.
template <class Change>
std::string refusal(Change change) {
  Log log = simulated();
  change(log);
  try {
    check(log);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST_F(LibraryLog, AWrittenLogIsReadBackUnchanged) {
  Log log = simulated();
  log.displacement[7] = nan;
  log.temperature_c.assign(log.time_s.size(), 21.5);
  const std::string path = file("log.csv");
  write_log(path, log);
  const Log read = read_log(path);
  EXPECT_EQ(read.time_s, log.time_s);
  EXPECT_EQ(read.pressure_command_kpa, log.pressure_command_kpa);
  EXPECT_EQ(read.temperature_c, log.temperature_c);
  EXPECT_TRUE(std::isnan(read.displacement[7]));
  EXPECT_EQ(read.displacement[8], log.displacement[8]);
  EXPECT_EQ(read.name, "log");
  EXPECT_EQ(read.sha256.size(), 64U);
}

TEST_F(LibraryLog, TheTimesOfAWrittenLogStartAtZero) {
  Log log = simulated();
  for (double& time_s : log.time_s) time_s += 128;
  const std::string path = file("log.csv");
  write_log(path, log);
  const Log read = read_log(path);
  ASSERT_EQ(read.time_s.size(), log.time_s.size());
  for (std::size_t i = 0; i < read.time_s.size(); ++i) ASSERT_EQ(read.time_s[i], log.time_s[i] - 128) << i;
  EXPECT_EQ(read.displacement, log.displacement);
}

TEST_F(LibraryLog, ImportsAFileOfAnotherProgram) {
  const Log log = simulated();
  std::string text = "Time [s];Pressure setpoint [bar];Displacement [mm]\n";
  for (std::size_t i = 0; i < log.time_s.size(); ++i)
    text += std::to_string(log.time_s[i]) + ";" + std::to_string(log.pressure_command_kpa[i] / 100) + ";" +
            std::to_string(log.displacement[i]) + "\n";
  const std::string path = file("other.csv", text);
  const Log read = read_log(path);
  ASSERT_EQ(read.time_s.size(), log.time_s.size());
  EXPECT_NEAR(read.pressure_command_kpa[100], log.pressure_command_kpa[100], 1e-4);
  ASSERT_FALSE(read.notes.empty());
  EXPECT_NE(read.notes.front().find("--command"), std::string::npos) << read.notes.front();
  const Log mapped = read_log(path, {.columns = {{"command", "2"}}, .units = {{"command", "kPa"}}});
  EXPECT_NEAR(mapped.pressure_command_kpa[100] * 100, log.pressure_command_kpa[100], 1e-4);
  EXPECT_THROW((void)read_log(path, {.import_file = false}), FileError);
  EXPECT_THROW((void)read_log(path, {.columns = {{"force", "2"}}}), InvalidArgument);
}

TEST_F(LibraryLog, RefusesInvalidFilesWithTheLineOfTheError) {
  EXPECT_THROW((void)read_log("/no/such/file.csv"), FileError);
  EXPECT_THROW((void)read_log(file("empty.csv", "\n")), FileError);
  EXPECT_THROW((void)read_log(file("text.csv", "a,b\nx,y\n")), FileError);
  try {
    (void)read_log(file("bad.csv", "time_s,pressure_command_kpa,displacement_mm\n0,1,2\n0.1,x,2\n0.2,3,4\n"));
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("bad.csv:3:"), std::string::npos) << error.what();
  }
}

TEST_F(LibraryLog, NamesTheColumnThatIsRefused) {
  EXPECT_EQ(refusal([](Log&) {}), "");
  EXPECT_EQ(refusal([](Log& log) { log.displacement.pop_back(); }),
            "displacement: 399 values, but there are 400 times. One value per time is required, in mm");
  EXPECT_EQ(refusal([](Log& log) { log.pressure_command_kpa[3] = nan; }),
            "pressure_command_kpa: value 3 is nan. All values must be finite numbers in kPa");
  EXPECT_EQ(refusal([](Log& log) { log.temperature_c = {1}; }).find("temperature_c: 1 values"), 0U);
  EXPECT_EQ(refusal([](Log& log) { log.time_s[5] = log.time_s[4]; }).find("time_s: value 5"), 0U);
  EXPECT_EQ(refusal([](Log& log) { log = {}; }).find("time_s: 0 values"), 0U);
  const std::string still = refusal([](Log& log) { log.pressure_command_kpa.assign(400, 20); });
  EXPECT_EQ(still.find("log: sine: "), 0U) << still;
}

TEST_F(LibraryLog, TimesMayBeginAnywhere) {
  EXPECT_EQ(refusal([](Log& log) {
              for (double& time_s : log.time_s) time_s += 100;
            }),
            "");
}

}  // namespace
}  // namespace softgrip::log_test
