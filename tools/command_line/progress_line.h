#pragma once
// How far long work is, on a terminal and in a file.

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace softgrip::tools {

/// How long the rest of a stage will take by what it took so far. Texts say how far they are as "3 of 20"; a
/// text without that, or of another whole, begins another stage.
class RestEstimate {
 public:
  /// The seconds that are left after `text`, which came at `now_s`; below 0: nobody can know yet.
  double left_s(const std::string& text, double now_s);

 private:
  std::size_t whole_ = 0;
  std::size_t first_ = 0;
  double began_s_ = 0;
};

/// On a terminal one line that is overwritten, cleared at the end. Elsewhere a line each ten seconds: what
/// was said last, how long it takes already and about how much longer.
class ProgressLine {
 public:
  explicit ProgressLine(std::FILE* to = stderr, std::chrono::milliseconds every = std::chrono::seconds(10));
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  /// What shows a text; "" shows nothing until the next one. May be called from any thread, while this lives.
  [[nodiscard]] std::function<void(const std::string&)> show();

 private:
  void say(const std::string& text);
  void repeat();
  [[nodiscard]] std::string latest() const;  ///< under the lock

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
