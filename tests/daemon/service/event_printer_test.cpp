#include "daemon/service/event_printer.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <sstream>
#include <thread>
#include <vector>

#include "base/descriptor.h"

namespace softgrip::daemon::event_printer_test {
namespace {

/// Returns the lines that a printer writes to the standard error.
std::vector<std::string> lines_of(const std::function<void(EventPrinter&)>& use) {
  ::testing::internal::CaptureStderr();
  {
    EventPrinter printer(false);
    use(printer);
  }
  std::istringstream text(::testing::internal::GetCapturedStderr());
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

/// Prints events of the kind "pressure_step" with a distance of 0.2 s.
void print_steps(EventPrinter& printer, int count) {
  for (int i = 0; i < count; ++i)
    printer.print(event_of("pressure_step", Severity::information, 0.2 * i, "a step"));
}

bool reports(const std::string& line, const std::string& count) {
  return line.find(count + " further events of the kind pressure_step were not printed") != std::string::npos;
}

TEST(EventPrinter, PrintsTwentyEventsOfOneKindAndTheNumberOfTheOthersAtTheEnd) {
  const auto lines = lines_of([](EventPrinter& printer) {
    print_steps(printer, 45);
    printer.print_end({});
  });
  ASSERT_GT(lines.size(), 21U);
  EXPECT_NE(lines[19].find("[3.800 s] a step"), std::string::npos) << lines[19];
  EXPECT_TRUE(reports(lines[20], "25")) << lines[20];
  for (std::size_t i = 21; i < lines.size(); ++i) EXPECT_FALSE(reports(lines[i], "")) << lines[i];
}

TEST(EventPrinter, ReportsTheNumberBeforeTheNextEventOfAnotherKind) {
  const auto lines = lines_of([](EventPrinter& printer) {
    print_steps(printer, 45);
    printer.print(event_of("vented", Severity::information, 9.5, "still in the same 10 s"));
    printer.print(event_of("vented", Severity::information, 30, "later"));
    printer.print(event_of("pressure_step", Severity::information, 31, "a single step"));
    printer.print_end({});
  });
  ASSERT_GT(lines.size(), 23U);
  EXPECT_NE(lines[20].find("still in the same 10 s"), std::string::npos) << lines[20];
  EXPECT_TRUE(reports(lines[21], "25")) << lines[21];
  EXPECT_NE(lines[22].find("later"), std::string::npos) << lines[22];
  EXPECT_NE(lines[23].find("a single step"), std::string::npos) << lines[23];
  for (std::size_t i = 24; i < lines.size(); ++i) EXPECT_FALSE(reports(lines[i], "")) << lines[i];
}

/// Prints one event while the pipe at the standard error is full, and reads the pipe 10 ms later. Returns the
/// part of the output that is in the pipe when wait_until_written() returns.
std::string output_through_a_full_pipe() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC), 0);
  const Descriptor reader(ends[0]);
  Descriptor writer(ends[1]);
  const std::string page(4096, 'x');
  while (::write(writer.get(), page.data(), page.size()) > 0) {
  }
  const Descriptor terminal(::dup(STDERR_FILENO));
  ::dup2(writer.get(), STDERR_FILENO);
  EventPrinter printer(true);
  printer.print(event_of("last", Severity::error, 0, "the last event"));
  std::thread late([&reader, &page] {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::string filling(64 * page.size(), '\0');
    EXPECT_GT(::read(reader.get(), filling.data(), filling.size()), 0);
  });
  printer.wait_until_written(std::chrono::seconds(20));
  ::dup2(terminal.get(), STDERR_FILENO);
  late.join();
  std::string output(page.size(), '\0');
  const ssize_t count = ::read(reader.get(), output.data(), output.size());
  output.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return output;
}

TEST(EventPrinter, WaitsUntilItsThreadHasWrittenAllLines) {
  // The printer drops a line that it cannot write within 200 ms, so a busy machine needs a second attempt.
  std::string output;
  for (int attempts = 0; output.empty() && attempts < 3; ++attempts) output = output_through_a_full_pipe();
  EXPECT_NE(output.find("the last event"), std::string::npos) << output;
}

TEST(EventPrinter, AnEndWithoutSuppressedEventsReportsNone) {
  const auto lines = lines_of([](EventPrinter& printer) {
    print_steps(printer, 20);
    printer.print_end({});
  });
  for (const std::string& line : lines) EXPECT_FALSE(reports(line, "")) << line;
}

}  // namespace
}  // namespace softgrip::daemon::event_printer_test
