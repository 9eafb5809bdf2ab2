#pragma once
// Collects the problems of a log. A file with a million bad rows is therefore reported in a few lines.

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "document/problem.h"

namespace softgrip::sysid {

/// Adds the first problems of each kind and counts the problems of this kind after them.
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
