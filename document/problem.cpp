#include "document/problem.h"

#include <algorithm>
#include <cstdint>
#include <map>

namespace softgrip::document {

namespace {

// Longest line that is shown completely [bytes]. Of a longer line, the part near the column of the problem is
// shown.
constexpr std::size_t line_bytes = 100;

/// The part of `line` to show: the whole line, or a window around `column` (from 0). The window begins and
/// ends between two characters.
struct Window {
  std::size_t begin;
  std::size_t end;
};

Window window_of(std::string_view line, std::size_t column) {
  if (line.size() <= line_bytes) return {0, line.size()};
  const auto inside_character = [&](std::size_t i) {
    return i < line.size() && (static_cast<unsigned char>(line[i]) & 0xC0) == 0x80;
  };
  std::size_t begin = column < line_bytes / 2 ? 0 : std::min(column, line.size()) - line_bytes / 2;
  begin = std::min(begin, line.size() - line_bytes);
  std::size_t end = begin + line_bytes;
  // Each end of the window moves to the start of the next character, but by at most three bytes: a text that
  // is not UTF-8 may have no start of a character.
  for (int i = 0; i < 3 && inside_character(begin); ++i) ++begin;
  for (int i = 0; i < 3 && inside_character(end); ++i) ++end;
  return {begin, end};
}

/// Appends the line that contains the problem, and a second line with a caret under the column.
void append_line(std::string& out, const Problem& problem) {
  const std::string_view line = problem.line_text;
  const std::size_t column = static_cast<std::size_t>(std::max(problem.at.column, 1)) - 1;
  const Window window = window_of(line, column);
  constexpr std::string_view margin = "    ";
  out += margin;
  std::size_t caret = margin.size();
  if (window.begin > 0) {
    out += "...";
    caret += 3;
  }
  std::string_view rest = line.substr(window.begin, window.end - window.begin);
  std::size_t at = window.begin;
  while (!rest.empty()) {
    const std::size_t before = rest.size();
    const std::size_t columns = append_visible(out, rest);
    at += before - rest.size();
    if (at <= column) caret += columns;
  }
  if (window.end < line.size()) out += "...";
  out += '\n';
  out.append(caret, ' ');
  out += "^\n";
}

void append_problem(std::string& out, const Problem& problem, bool warning) {
  out += place_of(problem) + ": ";
  if (warning) out += "warning: ";
  out += problem.message + '\n';
  if (!problem.line_text.empty()) append_line(out, problem);
  if (!problem.hint.empty()) out += "    hint: " + problem.hint + '\n';
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({change, above + 1, row[j - 1] + 1});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string text_of(Location at) {
  return std::to_string(at.line) + ":" + std::to_string(at.column);
}

std::string place_of(const Problem& problem) {
  return shown(problem.file, 400) + ":" + text_of(problem.at);
}

void Problems::add(Problem problem) {
  ++error_count_;
  if (errors_.size() < most) errors_.push_back(std::move(problem));
}

void Problems::warn(Problem problem) {
  ++warning_count_;
  if (warnings_.size() < most) warnings_.push_back(std::move(problem));
}

Problems Problems::without_repeats() const {
  Problems result;
  const auto copy = [](const std::vector<Problem>& from, std::vector<Problem>& to) {
    for (const Problem& problem : from) {
      if (std::find(to.begin(), to.end(), problem) == to.end()) to.push_back(problem);
    }
  };
  copy(errors_, result.errors_);
  copy(warnings_, result.warnings_);
  result.error_count_ = error_count_ - (errors_.size() - result.errors_.size());
  result.warning_count_ = warning_count_ - (warnings_.size() - result.warnings_.size());
  return result;
}

std::string Problems::format() const {
  struct Item {
    std::size_t file;
    const Problem* problem;
    bool warning;
  };
  std::map<std::string_view, std::size_t> files;
  std::vector<Item> items;
  for (const auto* list : {&errors_, &warnings_}) {
    for (const Problem& problem : *list) {
      const std::size_t file = files.try_emplace(problem.file, files.size()).first->second;
      items.push_back({file, &problem, list == &warnings_});
    }
  }
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    if (a.file != b.file) return a.file < b.file;
    const Location& p = a.problem->at;
    const Location& q = b.problem->at;
    return p.line != q.line ? p.line < q.line : p.column < q.column;
  });
  std::string out;
  for (const Item& item : items) append_problem(out, *item.problem, item.warning);
  const std::size_t left_out = error_count_ + warning_count_ - errors_.size() - warnings_.size();
  if (left_out > 0) out += "and " + std::to_string(left_out) + " more\n";
  return out;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  // At most a third of the letters may be different, but one different letter is always accepted. If more
  // letters are different, a typing error is improbable.
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    const std::size_t shorter = std::min(word.size(), candidate.size());
    if (longer - shorter >= best_distance) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < longer) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string in_backticks(std::string_view word) {
  return "`" + shown(word) + "`";
}

std::string shown(std::string_view text, std::size_t most) {
  std::string out;
  const std::size_t whole = text.size();
  while (!text.empty()) {
    if (whole - text.size() >= most) return out + "...";
    append_visible(out, text);
  }
  return out;
}

namespace {

constexpr std::uint8_t byte_of(char c) {
  return static_cast<std::uint8_t>(c);
}

struct Lead {
  std::size_t length;
  std::uint8_t second_lower;  // lower end of the allowed range of the second byte of a character; the range
                              // excludes overlong forms and surrogates
  std::uint8_t second_upper;
};

Lead lead_of(std::uint8_t first) noexcept {
  if (first < 0x80) return {1, 0, 0};
  if (first < 0xC2) return {0, 0, 0};
  if (first < 0xE0) return {2, 0x80, 0xBF};
  if (first == 0xE0) return {3, 0xA0, 0xBF};
  if (first == 0xED) return {3, 0x80, 0x9F};
  if (first < 0xF0) return {3, 0x80, 0xBF};
  if (first == 0xF0) return {4, 0x90, 0xBF};
  if (first < 0xF4) return {4, 0x80, 0xBF};
  if (first == 0xF4) return {4, 0x80, 0x8F};
  return {0, 0, 0};
}

}  // namespace

std::size_t character_length(std::string_view text) noexcept {
  const Lead lead = lead_of(byte_of(text[0]));
  if (lead.length < 2) return lead.length;
  if (text.size() < lead.length) return 0;
  const std::uint8_t second = byte_of(text[1]);
  if (second < lead.second_lower || second > lead.second_upper) return 0;
  for (std::size_t i = 2; i < lead.length; ++i) {
    if ((byte_of(text[i]) & 0xC0) != 0x80) return 0;
  }
  return lead.length;
}

bool is_control(std::string_view character) noexcept {
  const std::uint8_t first = byte_of(character[0]);
  if (first < 0x20 || first == 0x7F) return true;
  return character.size() == 2 && first == 0xC2 && byte_of(character[1]) < 0xA0;
}

std::size_t append_visible(std::string& out, std::string_view& text) {
  const std::size_t length = character_length(text);
  if (length != 0 && !is_control(text.substr(0, length))) {
    out.append(text.substr(0, length));
    text.remove_prefix(length);
    return 1;
  }
  const std::size_t taken = length == 0 ? 1 : length;
  const std::size_t before = out.size();
  for (const char c : text.substr(0, taken)) {
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (c == '\r') {
      out += "\\r";
    } else {
      constexpr char digits[] = "0123456789abcdef";
      out += "\\x";
      out += digits[byte_of(c) >> 4];
      out += digits[byte_of(c) & 15];
    }
  }
  text.remove_prefix(taken);
  return out.size() - before;
}

}  // namespace softgrip::document
