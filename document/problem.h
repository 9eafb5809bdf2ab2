#pragma once
// Problems found in a text document, each with its place, so that a user sees all of them at once.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace softgrip::document {

/// A place in a text. Both count from 1; column counts bytes.
struct Location {
  int line = 1;
  int column = 1;

  bool operator==(const Location&) const = default;
};

/// One thing that is wrong with a document.
struct Problem {
  std::string file;       ///< as the user named it
  Location at;            ///< where
  std::string line_text;  ///< the line itself, without its line break (empty where there is none)
  std::string message;    ///< what is wrong, one sentence
  std::string hint;       ///< what was probably meant, or empty

  bool operator==(const Problem&) const = default;
};

/// All problems of one or several documents, in the order in which they were found. Errors and warnings are
/// kept apart: a document with an error is refused, one with warnings is accepted and they are shown.
/// Of each, the first `most` are kept and the others counted.
class Problems {
 public:
  static constexpr std::size_t most = 200;

  void add(Problem problem);
  void warn(Problem problem);

  /// Of the errors alone, those that are only counted included.
  [[nodiscard]] bool empty() const noexcept { return error_count_ == 0; }
  [[nodiscard]] std::size_t size() const noexcept { return error_count_; }
  /// True when further errors are only counted: looking for more is wasted.
  [[nodiscard]] bool full() const noexcept { return error_count_ >= most; }
  [[nodiscard]] const std::vector<Problem>& list() const noexcept { return errors_; }
  [[nodiscard]] const std::vector<Problem>& warnings() const noexcept { return warnings_; }

  /// One block per problem: `file:line:col: message` (`file:line:col: warning: message`), the line, a caret
  /// under the column, the hint. Files in the order of their first problem, each by line. Ends with a line
  /// break unless there is nothing to say.
  [[nodiscard]] std::string format() const;

  /// Returns the problems without repetitions: a file that was read more than once repeats its problems.
  [[nodiscard]] Problems without_repeats() const;

 private:
  std::vector<Problem> errors_;
  std::vector<Problem> warnings_;
  std::size_t error_count_ = 0;
  std::size_t warning_count_ = 0;
};

/// The candidate nearest to `word` by edit distance, or empty when none is near enough to suggest.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// `text` for a terminal: control characters and bytes that are not UTF-8 as \n, \t, \xNN; after `most` bytes
/// of it comes "...".
[[nodiscard]] std::string shown(std::string_view text, std::size_t most = 60);
/// A name or a value as messages set it off: `so`.
[[nodiscard]] std::string in_backticks(std::string_view word);

}  // namespace softgrip::document
