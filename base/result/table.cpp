#include "base/result/table.h"

#include <algorithm>
#include <string_view>

namespace softgrip::result {

std::string text_of(const Table& table) {
  // Counts the UTF-8 characters of a text: all bytes except continuation bytes.
  const auto width_of = [](std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & '\xc0') != '\x80'; }));
  };
  std::vector<std::size_t> widths;
  const auto widen = [&](const std::vector<std::string>& cells) {
    widths.resize(std::max(widths.size(), cells.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) widths[c] = std::max(widths[c], width_of(cells[c]));
  };
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string room(widths[c] - width_of(cells[c]), ' ');
      text += "  " + (table.numeric[c] ? room + cells[c] : cells[c] + room);
    }
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  };
  widen(table.header);
  for (const std::vector<std::string>& row : table.rows) widen(row);
  std::string text = table.caption + "\n" + line(table.header);
  for (const std::vector<std::string>& row : table.rows) text += line(row);
  return text;
}

}  // namespace softgrip::result
