#pragma once
// Collects the problems of a log and shows only the first problems of each kind, so that a few lines report a
// file with a million bad rows.

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "document/problem.h"

namespace softgrip::sysid {

/// Reports the first problems of each kind and counts the remaining problems of the same kind.
class LogReporter {
 public:
  LogReporter(std::string file, document::Problems& problems) : file_(std::move(file)), problems_(problems) {}

  void add(const std::string& kind, document::Location at, std::string_view line, std::string message,
           std::string hint = {});
  /// Adds, for each kind of problem, one problem that states how many problems of this kind are not shown.
  void finish();
  [[nodiscard]] bool any() const { return !counts_.empty(); }

 private:
  std::string file_;
  document::Problems& problems_;
  std::map<std::string, int> counts_;
  std::map<std::string, std::pair<document::Location, std::string>> last_;
};

}  // namespace softgrip::sysid
