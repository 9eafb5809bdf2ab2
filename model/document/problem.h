#pragma once
// Problems found in a text document, each with its place, so that a user sees all of them at once.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softgrip::document {

/// A place in a text. Both count from 1; column counts bytes.
struct Location {
  int line = 1;
  int column = 1;
};

/// One thing that is wrong with a document.
struct Problem {
  std::string file;       ///< as the user named it
  Location at;            ///< where
  std::string line_text;  ///< the line itself, without its line break (empty where there is none)
  std::string message;    ///< what is wrong, one sentence
  std::string hint;       ///< what was probably meant, or empty
};

/// All problems of one or several documents, in the order in which they were found.
class Problems {
 public:
  void add(Problem problem) { list_.push_back(std::move(problem)); }
  [[nodiscard]] bool empty() const noexcept { return list_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return list_.size(); }
  [[nodiscard]] const std::vector<Problem>& list() const noexcept { return list_; }

  /// One block per problem: `file:line:col: message`, the line, a caret under the column, the hint.
  [[nodiscard]] std::string format() const;

 private:
  std::vector<Problem> list_;
};

/// The candidate nearest to `word` by edit distance, or empty when none is near enough to suggest.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace softgrip::document
