#include "sysid/logs/csv_text.h"

#include <algorithm>

namespace softgrip::sysid {

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

bool split(std::string_view line, std::vector<Cell>& cells, char separator) {
  cells.clear();
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i == line.size() || (line[i] == separator && !quoted)) {
      cells.push_back({line.substr(begin, i - begin), static_cast<int>(begin) + 1});
      begin = i + 1;
    }
  }
  return !quoted;
}

void CutOffDetector::add(std::string_view line, std::string_view last_cell) {
  if (rows_++ > 0) shortest_before_ = std::min(shortest_before_, last_length_);
  last_line_ = line;
  last_length_ = unquoted(last_cell).size();
}

bool CutOffDetector::may_be_cut_off(std::string_view text) const {
  const bool without_line_break = last_line_.data() + last_line_.size() == text.data() + text.size();
  return rows_ > 2 && without_line_break && last_length_ < shortest_before_;
}

std::string cut_off_sentence(std::string_view last_cell) {
  return "the last row may be cut off: it does not end with a line break, and its last cell '" +
         std::string(unquoted(last_cell)) +
         "' is shorter than the last cells of all other rows. Check this value, or delete the row";
}

std::string left_out_sentence(std::size_t line) {
  return "line " + std::to_string(line) + ": the last line is cut off and left out";
}

std::string_view unquoted(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return text.substr(1, text.size() - 2);
  return text;
}

std::string cell_text(std::string_view cell) {
  const std::string_view inside = unquoted(cell);
  std::string text(inside);
  const bool was_quoted = inside.data() != cell.data() && !cell.empty() && inside.data()[-1] == '"';
  for (std::size_t at = 0; was_quoted && (at = text.find("\"\"", at)) != std::string::npos; ++at)
    text.erase(at, 1);
  return text;
}

std::string as_cell(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  const bool plain = text.find_first_of(",\"\r") == std::string_view::npos &&
                     (text.empty() || (!is_blank(text.front()) && !is_blank(text.back())));
  if (plain) return std::string(text);
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

}  // namespace softgrip::sysid
