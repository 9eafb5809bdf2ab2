#include "tools/command_line/progress_line.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>

namespace softgrip::tools::progress_line_test {
namespace {

TEST(RestEstimate, ExtrapolatesTheTimePerStep) {
  RestEstimate estimate;
  EXPECT_LT(estimate.left_s("start 1 of 20", 10), 0) << "no estimate of the remaining time is possible yet";
  EXPECT_NEAR(estimate.left_s("start 6 of 20, best RMSE 0.3 mm", 15), 14, 1e-9);
  EXPECT_NEAR(estimate.left_s("start 20 of 20", 29), 0, 1e-9);
}

TEST(RestEstimate, RestartsAtANewTotalOrASmallerNumber) {
  RestEstimate estimate;
  (void)estimate.left_s("start 1 of 20", 0);
  (void)estimate.left_s("start 11 of 20", 10);
  EXPECT_LT(estimate.left_s("data simulated without a cause: 12 of 19", 11), 0);
  EXPECT_NEAR(estimate.left_s("data simulated without a cause: 13 of 19", 13), 12, 1e-9);
  EXPECT_LT(estimate.left_s("data simulated without a cause: 1 of 19", 14), 0);
  EXPECT_LT(estimate.left_s("choosing the ridge", 15), 0);
  EXPECT_LT(estimate.left_s("one of many", 16), 0);
}

std::string text_of(std::FILE* file) {
  std::rewind(file);
  std::array<char, 4096> buffer{};
  return {buffer.data(), std::fread(buffer.data(), 1, buffer.size(), file)};
}

TEST(ProgressLine, PrintsPlainLinesAtIntervalsIfTheOutputIsNoTerminal) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  {
    ProgressLine line(file.get(), std::chrono::milliseconds(20));
    const auto show = line.show();
    show("start 1 of 4000");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    show("start 2 of 4000");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    show("start 4000 of 4000");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  const std::string text = text_of(file.get());
  EXPECT_NE(text.find("start 2 of 4000, about "), std::string::npos) << text;
  EXPECT_NE(text.find("start 4000 of 4000\n"), std::string::npos)
      << "the line must not state that 0 s remain: " << text;
  EXPECT_EQ(text.find('\033'), std::string::npos);
}

TEST(ProgressLine, PrintsNothingForShortWork) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  {
    ProgressLine line(file.get());
    line.show()("start 1 of 4");
  }
  EXPECT_EQ(text_of(file.get()), "");
}

}  // namespace
}  // namespace softgrip::tools::progress_line_test
