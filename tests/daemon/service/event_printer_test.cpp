#include "daemon/service/event_printer.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>
#include <vector>

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

TEST(EventPrinter, AnEndWithoutSuppressedEventsReportsNone) {
  const auto lines = lines_of([](EventPrinter& printer) {
    print_steps(printer, 20);
    printer.print_end({});
  });
  for (const std::string& line : lines) EXPECT_FALSE(reports(line, "")) << line;
}

}  // namespace
}  // namespace softgrip::daemon::event_printer_test
