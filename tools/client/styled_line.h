#pragma once
// Lines of a terminal that know how wide they are, whatever escapes and multi-byte characters they hold.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softgrip::tools {

struct ViewStyle {
  std::size_t columns = 80;  ///< no line is longer
  bool colour = false;       ///< ANSI colours
  bool unicode = false;      ///< block characters in bars and trends
};

enum class Tone : unsigned char { plain, strong, good, doubtful, bad, faint };

/// Text of one tone.
struct Span {
  std::string text;
  Tone tone = Tone::plain;
};

/// One line. What does not fit is cut with a sign: an ellipsis, or `>` without unicode.
class Line {
 public:
  explicit Line(const ViewStyle& style) : style_(style) {}

  /// Adds ASCII text.
  Line& add(std::string_view text, Tone tone = Tone::plain);
  /// Adds one character that is one column wide.
  Line& add_glyph(std::string_view glyph, Tone tone = Tone::plain);
  /// Adds blanks up to a column, counted from 0.
  Line& to_column(std::size_t column);

  [[nodiscard]] std::size_t columns() const noexcept { return columns_; }
  [[nodiscard]] const ViewStyle& style() const noexcept { return style_; }
  /// With escapes, cut to the style's columns.
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

/// Spans one behind the other, each whole; one that does not fit any more begins another line, `indent`
/// blanks in. Blanks that would begin a line are left out.
[[nodiscard]] std::vector<std::string> flowed(const ViewStyle& style, const std::vector<Span>& spans,
                                              std::size_t indent);

/// ASCII text broken at its line breaks, and at its blanks where it is too long; all lines but the first
/// begin `indent` blanks in.
[[nodiscard]] std::vector<std::string> broken(const ViewStyle& style, std::string_view text, Tone tone,
                                              std::size_t indent);

}  // namespace softgrip::tools
