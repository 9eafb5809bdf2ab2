#pragma once
// How far long work is, on a terminal.

#include <functional>
#include <string>

namespace softgrip::tools {

/// One line of the standard error that is overwritten, where that is a terminal; cleared at the end.
/// Elsewhere nothing is said.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  /// What shows a text in the line; empty where there is no terminal.
  [[nodiscard]] std::function<void(const std::string&)> show() const;

 private:
  bool shown_;
};

}  // namespace softgrip::tools
