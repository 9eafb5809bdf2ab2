#include "tools/log_input/log_input.h"
#include "base/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace softgrip::tools::log_input_test {
namespace {

constexpr std::size_t samples = 400;

/// Writes a log and returns its path. The log begins immediately after the command has jumped from 5 to 60
/// kPa. After 4 s, the command jumps to 30 kPa. The pressure follows with a lag of 0.3 s. If `measured` is
/// false, the log has no column of the measured pressure. The pressure is missing in the samples
/// [`gap_begin`, `gap_end`).
std::string begun_at_a_step(const ScratchFolder& folder, bool measured = true, std::size_t gap_begin = 0,
                            std::size_t gap_end = 0) {
  const std::string path = folder.path() + "/step.csv";
  std::ofstream out(path);
  out << "time_s,pressure_command_kpa,displacement_mm" << (measured ? ",pressure_kpa\n" : "\n");
  for (std::size_t i = 0; i < samples; ++i) {
    const double t_s = 0.02 * static_cast<double>(i);
    const double command_kpa = t_s < 4 ? 60 : 30;
    const double pressure_kpa =
        t_s < 4 ? 60 - 55 * std::exp(-t_s / 0.3) : 30 + 30 * std::exp(-(t_s - 4) / 0.3);
    out << t_s << ',' << command_kpa << ',' << 0.3 * pressure_kpa + 0.01 * static_cast<double>(i % 3);
    if (measured) out << ',';
    if (measured && (i < gap_begin || i >= gap_end)) out << pressure_kpa;
    out << '\n';
  }
  return path;
}

TEST(LogInput, InsertsAnInitialSampleIfTheLogStartsAtACommandStep) {
  const ScratchFolder folder;
  const auto logs = read_logs({begun_at_a_step(folder)}, {});
  ASSERT_TRUE(logs);
  ASSERT_EQ(logs->front().size(), samples + 1);
  EXPECT_EQ(logs->front().pressure_command_kpa.front(), 5);
  EXPECT_TRUE(std::isnan(logs->front().displacement_mm.front()));
}

TEST(LogInput, StartsAtTheLowestCommandWithoutAMeasuredPressure) {
  const ScratchFolder folder;
  LogInput staged;
  staged.begins_at_measured_pressure = true;
  const auto logs = read_logs({begun_at_a_step(folder, false)}, staged);
  ASSERT_TRUE(logs);
  ASSERT_EQ(logs->front().size(), samples + 1);
  EXPECT_EQ(logs->front().pressure_command_kpa.front(), 30)
      << "the inserted sample has the lowest command of the log";
}

TEST(LogInput, InsertsNoSampleIfTheMeasuredPressureIsTheInput) {
  const ScratchFolder folder;
  const std::string path = begun_at_a_step(folder);
  LogInput staged;
  staged.begins_at_measured_pressure = true;
  LogInput measured;
  measured.drive = "measured";
  for (const LogInput& input : {staged, measured}) {
    const auto logs = read_logs({path}, input);
    ASSERT_TRUE(logs);
    EXPECT_EQ(logs->front().size(), samples) << input.drive;
  }
}

TEST(LogInput, RefusesAGapInTheMeasuredPressureThatIsTheInput) {
  const ScratchFolder folder;
  const std::string path = begun_at_a_step(folder, true, 180, 230);
  const auto by_command = read_logs({path}, {});
  ASSERT_TRUE(by_command);
  EXPECT_TRUE(by_command->front().notes.front().text.starts_with("a gap of 1.02 s in the measured pressure"))
      << by_command->front().notes.front().text;
  LogInput measured;
  measured.drive = "measured";
  EXPECT_FALSE(read_logs({path}, measured));
  EXPECT_TRUE(read_logs({begun_at_a_step(folder, true, 210, 260)}, measured))
      << "the command is constant while the pressure is missing";
}

}  // namespace
}  // namespace softgrip::tools::log_input_test
