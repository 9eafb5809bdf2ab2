#include "tools/client/styled_line.h"

#include <algorithm>

namespace softgrip::tools {
namespace {

const char* escape_of(Tone tone) {
  switch (tone) {
    case Tone::strong:
      return "\x1b[1m";
    case Tone::good:
      return "\x1b[32m";
    case Tone::warning:
      return "\x1b[33m";
    case Tone::bad:
      return "\x1b[1;31m";
    case Tone::faint:
      return "\x1b[2m";
    case Tone::plain:
      break;
  }
  return "";
}

std::string coloured(const ViewStyle& style, std::string_view text, Tone tone) {
  const std::string_view escape = style.colour ? escape_of(tone) : "";
  std::string result(escape);
  result += text;
  if (!escape.empty()) result += "\x1b[0m";
  return result;
}

}  // namespace

Line& Line::add(std::string_view text, Tone tone) {
  if (text.empty()) return *this;
  pieces_.push_back({std::string(text), text.size(), tone});
  columns_ += text.size();
  return *this;
}

Line& Line::add_glyph(std::string_view glyph, Tone tone) {
  pieces_.push_back({std::string(glyph), 1, tone});
  ++columns_;
  return *this;
}

Line& Line::to_column(std::size_t column) {
  if (columns_ < column) add(std::string(column - columns_, ' '));
  return *this;
}

std::string Line::text() const {
  const bool cut = columns_ > style_.columns;
  std::size_t left = cut ? style_.columns - std::min<std::size_t>(style_.columns, 1) : columns_;
  std::string result;
  for (const Piece& piece : pieces_) {
    if (left == 0) break;
    const bool whole = piece.columns <= left;
    const std::string_view text = piece.text;
    result += coloured(style_, whole ? text : text.substr(0, left), piece.tone);
    left -= whole ? piece.columns : left;
  }
  if (cut && style_.columns > 0) result += coloured(style_, style_.unicode ? "…" : ">", Tone::faint);
  return result;
}

std::vector<std::string> wrap_spans(const ViewStyle& style, const std::vector<Span>& spans,
                                    std::size_t indent) {
  std::vector<std::string> lines;
  Line line(style);
  std::size_t begins = 0;
  for (const Span& span : spans) {
    if (line.columns() > begins && line.columns() + span.text.size() > style.columns) {
      lines.push_back(line.text());
      line = Line(style);
      begins = std::min(indent, style.columns / 2);
      line.to_column(begins);
    }
    const bool first_of_line = line.columns() == begins && !lines.empty();
    const std::size_t blanks = std::min(span.text.find_first_not_of(' '), span.text.size());
    line.add(std::string_view(span.text).substr(first_of_line ? blanks : 0), span.tone);
  }
  lines.push_back(line.text());
  return lines;
}

std::vector<std::string> wrap_text(const ViewStyle& style, std::string_view text, Tone tone,
                                   std::size_t indent) {
  std::vector<std::string> lines;
  std::size_t begins = 0;
  do {
    const std::size_t room = std::max<std::size_t>(style.columns - std::min(style.columns, begins), 1);
    std::size_t length = std::min(text.find('\n'), text.size());
    if (length > room) {
      const std::size_t space = text.rfind(' ', room);
      length = space == std::string_view::npos || space == 0 ? room : space;
    }
    lines.push_back(Line(style).to_column(begins).add(text.substr(0, length), tone).text());
    text.remove_prefix(length);
    if (text.starts_with(' ') || text.starts_with('\n')) text.remove_prefix(1);
    begins = std::min(indent, style.columns / 2);
  } while (!text.empty());
  return lines;
}

}  // namespace softgrip::tools
