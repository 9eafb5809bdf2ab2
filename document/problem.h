#pragma once
// Defines problems of a text document with their locations. All problems of a document are shown together.
// Recognises UTF-8 characters and control characters in a text, and converts any bytes to a form that a
// terminal can show.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softgrip::document {

/// A location in a text. Line and column are numbered from 1. The column is counted in bytes.
struct Location {
  int line = 1;
  int column = 1;

  bool operator==(const Location&) const = default;
};
/// Returns "LINE:COLUMN".
[[nodiscard]] std::string text_of(Location at);

/// A problem of a document.
struct Problem {
  std::string file;       ///< name of the file as the user wrote it
  Location at;            ///< location of the problem in the file
  std::string line_text;  ///< text of the line that contains the problem, without its line break; may be
                          ///< empty
  std::string message;    ///< the problem in one sentence
  std::string hint;       ///< advice for the correction of the document; empty: no advice

  bool operator==(const Problem&) const = default;
};
/// Returns "FILE:LINE:COLUMN".
[[nodiscard]] std::string place_of(const Problem& problem);

/// All problems of one or several documents, in the order in which they were found. A document with an error
/// is refused. A document that has only warnings is accepted, and its warnings are shown. The first `most`
/// errors and the first `most` warnings are stored. Errors and warnings after these are counted but not
/// stored.
class Problems {
 public:
  static constexpr std::size_t most = 200;

  void add(Problem problem);
  void warn(Problem problem);

  /// empty() and size() count errors, including those that were not stored. Warnings are not counted.
  [[nodiscard]] bool empty() const noexcept { return error_count_ == 0; }
  [[nodiscard]] std::size_t size() const noexcept { return error_count_; }
  /// Returns true if no more errors will be stored, so that the caller can stop to check the document.
  [[nodiscard]] bool full() const noexcept { return error_count_ >= most; }
  [[nodiscard]] const std::vector<Problem>& list() const noexcept { return errors_; }
  [[nodiscard]] const std::vector<Problem>& warnings() const noexcept { return warnings_; }

  /// Returns a block of lines for each problem: `file:line:col: message` (`file:line:col: warning: message`),
  /// the text of the line, a caret under the column, and the hint. Files are in the order of their first
  /// problem, and the problems of a file are in the order of their lines. The text is empty or ends with a
  /// line break.
  [[nodiscard]] std::string format() const;

  /// Returns the problems, each of them once. A problem occurs more than once if a file was read more than
  /// once.
  [[nodiscard]] Problems without_repeats() const;

 private:
  std::vector<Problem> errors_;
  std::vector<Problem> warnings_;
  std::size_t error_count_ = 0;
  std::size_t warning_count_ = 0;
};

/// Returns the candidate with the smallest edit distance to `word`, or an empty text if no candidate is
/// similar to `word`.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// Returns `text` in a form that is safe for a terminal. Control characters and bytes that are not UTF-8
/// become \n, \t or \xNN. If `text` is longer than `most` bytes, "..." replaces the rest.
[[nodiscard]] std::string shown(std::string_view text, std::size_t most = 60);
/// Returns a name or a value in backticks for a message.
[[nodiscard]] std::string in_backticks(std::string_view word);

/// Returns the length of the first UTF-8 character of `text` in bytes. Returns 0 if the first bytes are not
/// valid UTF-8; overlong forms, surrogates and values above U+10FFFF are not valid. `text` must not be empty.
[[nodiscard]] std::size_t character_length(std::string_view text) noexcept;

/// Returns true if a character is a control character (U+0000 to U+001F, U+007F to U+009F). The character
/// must be valid and have 1 or 2 bytes.
[[nodiscard]] bool is_control(std::string_view character) noexcept;

/// Removes the first character from `text` and appends it to `out`, after control characters and invalid
/// bytes are made visible. Returns the number of terminal columns that were appended. `text` must not be
/// empty.
std::size_t append_visible(std::string& out, std::string_view& text);

}  // namespace softgrip::document
