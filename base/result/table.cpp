#include "base/result/table.h"

#include <algorithm>

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

std::string escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size() + text.size() / 8);
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      case '\t':
      case '\n':
        safe += c;
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
          safe += "\xef\xbf\xbd";
        } else {
          safe += c;
        }
    }
  }
  return safe;
}

std::string element(std::string_view name, std::string_view text) {
  return '<' + std::string(name) + '>' + escaped(text) + "</" + std::string(name) + ">\n";
}

std::string html_of(const Terms& terms) {
  std::string html = "<dl>\n";
  for (const auto& [term, value] : terms) html += element("dt", term) + element("dd", value);
  return html + "</dl>\n";
}

std::string html_of(const Table& table) {
  const auto cell = [&](std::string_view tag, std::size_t column, std::string_view text) {
    const bool numeric = column < table.numeric.size() && table.numeric[column];
    return '<' + std::string(tag) + (numeric ? " class=\"n\">" : ">") + escaped(text) + "</" +
           std::string(tag) + '>';
  };
  std::string html = "<div class=\"scroll\"><table>";
  if (!table.caption.empty()) html += element("caption", table.caption);
  html += "<thead><tr>";
  for (std::size_t i = 0; i < table.header.size(); ++i) html += cell("th", i, table.header[i]);
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) html += cell("td", i, row[i]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace softgrip::result
