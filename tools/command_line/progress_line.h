#pragma once
// Shows the progress of long computations on a terminal and in a file.

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace softgrip::tools {

/// Estimates the remaining time of a computation from its elapsed time. The texts state the progress as "3 of
/// 20". A text that states no progress, or a total different from that of the previous text, begins a new
/// estimate.
class RestEstimate {
 public:
  /// Returns the remaining time [s] after `text`, which was shown at `now_s`. A negative value means unknown.
  double left_s(const std::string& text, double now_s);

 private:
  std::size_t whole_ = 0;
  std::size_t first_ = 0;
  double began_s_ = 0;
};

/// Shows the progress. On a terminal, overwrites one line and clears this line at the end. If the output is
/// not a terminal, prints a line every 10 s with the latest text, the elapsed time and the estimated
/// remaining time.
class ProgressLine {
 public:
  explicit ProgressLine(std::FILE* to = stderr, std::chrono::milliseconds every = std::chrono::seconds(10));
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  /// Returns a function that shows a text; "" hides the line until the next text. Any thread may call the
  /// function during the lifetime of this object.
  [[nodiscard]] std::function<void(const std::string&)> show();

 private:
  void say(const std::string& text);
  void repeat();
  [[nodiscard]] std::string latest() const;  ///< the caller must hold the lock

  std::FILE* to_;
  std::chrono::milliseconds every_;
  bool terminal_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable over_;
  bool ended_ = false;
  std::string text_;
  double left_s_ = -1;
  double said_s_ = 0;
  RestEstimate estimate_;
  std::thread repeater_;
};

}  // namespace softgrip::tools
