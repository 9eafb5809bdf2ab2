#pragma once
// Formats lines for a terminal of known width. A multi-byte character counts as one column. An escape
// sequence counts as no column.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softgrip::tools {

struct ViewStyle {
  std::size_t columns = 80;  ///< largest length of a line in columns
  bool colour = false;       ///< true: texts may have ANSI colours
  bool unicode = false;      ///< true: bars and trends may use block characters
};

enum class Tone : unsigned char { plain, strong, good, warning, bad, faint };

/// A text with one tone, for example plain, strong or bad.
struct Span {
  std::string text;
  Tone tone = Tone::plain;
};

/// One line of styled text. A line that is too long is cut and ends with an ellipsis. If the terminal has no
/// Unicode, the cut line ends with `>`.
class Line {
 public:
  explicit Line(const ViewStyle& style) : style_(style) {}

  /// Adds ASCII text at the end of the line.
  Line& add(std::string_view text, Tone tone = Tone::plain);
  /// Adds one character at the end of the line. The character may have several bytes, but must be one column
  /// wide.
  Line& add_glyph(std::string_view glyph, Tone tone = Tone::plain);
  /// Adds blanks until the line reaches the column `column`, counted from 0.
  Line& to_column(std::size_t column);

  [[nodiscard]] std::size_t columns() const noexcept { return columns_; }
  [[nodiscard]] const ViewStyle& style() const noexcept { return style_; }
  /// Returns the line with its escape sequences, cut to the largest length of a line.
  [[nodiscard]] std::string text() const;

 private:
  struct Piece {
    std::string text;
    std::size_t columns = 0;
    Tone tone = Tone::plain;
  };
  ViewStyle style_;
  std::vector<Piece> pieces_;
  std::size_t columns_ = 0;
};

/// Arranges spans one after the other. A span that does not fit on the present line begins a new line,
/// indented by `indent` blanks. Blanks at the beginning of a line are omitted.
[[nodiscard]] std::vector<std::string> wrap_spans(const ViewStyle& style, const std::vector<Span>& spans,
                                                  std::size_t indent);

/// Splits ASCII text at its line breaks. A line that is too long is also split at a blank. All lines after
/// the first are indented by `indent` blanks.
[[nodiscard]] std::vector<std::string> wrap_text(const ViewStyle& style, std::string_view text, Tone tone,
                                                 std::size_t indent);

}  // namespace softgrip::tools
