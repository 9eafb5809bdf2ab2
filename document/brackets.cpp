#include "document/brackets.h"

#include <algorithm>
#include <cctype>

namespace softgrip::document {

namespace {

/// Reads a text line by line and keeps the list of open brackets.
class Scan {
 public:
  void line(std::string_view text, int number) {
    const std::size_t indent = std::min(text.find_first_not_of(' '), text.size());
    const bool blank = indent == text.size();
    if (open_.empty() && quote_ == 0 && folded_ && (blank || indent > folded_indent_)) return;
    folded_ = false;
    begins_value_ = true;
    for (std::size_t i = indent; i < text.size(); ++i) {
      if (quote_ == 0 && text[i] == '#' && (i == 0 || text[i - 1] == ' ')) break;
      i += step(text, i, number);
    }
    const std::size_t last = text.find_last_not_of(" +-0123456789");
    if (open_.empty() && quote_ == 0 && !blank && last != std::string_view::npos && last > 1 &&
        (text[last] == '|' || text[last] == '>') && text[last - 1] == ' ') {
      folded_ = true;
      folded_indent_ = indent;
    }
  }

  [[nodiscard]] std::vector<Bracket> open() const { return open_; }

 private:
  /// Reads the character at index `i`. Returns the number of characters after this character that are read
  /// together with it: 1 for the backslash of `\"`.
  std::size_t step(std::string_view text, std::size_t i, int number) {
    const char c = text[i];
    if (quote_ != 0) {
      if (c == '\\' && quote_ == '"') return 1;
      if (c != quote_) return 0;
      if (c == '\'' && i + 1 < text.size() && text[i + 1] == c) return 1;
      quote_ = 0;
      return 0;
    }
    const bool value_begins = begins_value_;
    if (c == ' ') return 0;
    const bool before_blank = i + 1 == text.size() || text[i + 1] == ' ';
    begins_value_ = c == ',' || c == '[' || c == '{' || ((c == ':' || c == '-') && before_blank);
    if ((c == '"' || c == '\'') && value_begins) quote_ = c;
    if ((c == '[' || c == '{') && (value_begins || !open_.empty())) {
      open_.push_back({c, {number, static_cast<int>(i) + 1}});
    }
    const char opener = c == ']' ? '[' : c == '}' ? '{' : '\0';
    if (opener != '\0' && !open_.empty() && open_.back().character == opener) open_.pop_back();
    return 0;
  }

  std::vector<Bracket> open_;
  char quote_ = 0;
  bool begins_value_ = true;
  bool folded_ = false;  // true: the text is inside a `|` or `>` block; folded_indent_ is the indentation of
                         // the line that opened the block
  std::size_t folded_indent_ = 0;
};

}  // namespace

std::vector<Bracket> open_brackets(std::string_view text, Location place) {
  Scan scan;
  for (int number = 1; number <= place.line; ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (number == place.line) {
      line = line.substr(0, std::min(line.size(), static_cast<std::size_t>(std::max(place.column, 1)) - 1));
    }
    scan.line(line, number);
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return scan.open();
}

}  // namespace softgrip::document
