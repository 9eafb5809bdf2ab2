#pragma once
// Lists the problems that the parser finds in a text. Used by the tests of documents.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "document/node.h"

namespace softgrip::document {

/// Returns the problems of a text, each as "line:column: message", for example "2:10: message".
inline std::vector<std::string> lines_of(const Problems& problems) {
  std::vector<std::string> lines;
  for (const Problem& problem : problems.list()) {
    lines.push_back(std::to_string(problem.at.line) + ":" + std::to_string(problem.at.column) + ": " +
                    problem.message);
  }
  return lines;
}

inline std::vector<std::string> problems_of(const std::string& text, const Bounds& bounds = {}) {
  Problems problems;
  static_cast<void>(parse("test.yaml", text, problems, bounds));
  return lines_of(problems);
}

using Lines = std::vector<std::string>;

}  // namespace softgrip::document
