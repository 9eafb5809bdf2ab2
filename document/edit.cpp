#include "document/edit.h"

#include <algorithm>

namespace softgrip::document {

const Node::Entry* entry_of(const Node* node, std::string_view key) noexcept {
  if (node == nullptr) return nullptr;
  const auto found = std::find_if(node->entries.begin(), node->entries.end(),
                                  [&](const Node::Entry& entry) { return entry.key == key; });
  return found == node->entries.end() ? nullptr : &*found;
}

const Node* below(const Node* node, const std::vector<std::string_view>& path) noexcept {
  for (const std::string_view key : path) {
    const Node::Entry* const entry = entry_of(node, key);
    node = entry == nullptr ? nullptr : &entry->value;
  }
  return node;
}

std::optional<std::size_t> offset_of(std::string_view text, Location at) noexcept {
  std::size_t offset = 0;
  for (int line = 1; line < at.line; ++line) {
    const std::size_t end = text.find('\n', offset);
    if (end == std::string_view::npos) return std::nullopt;
    offset = end + 1;
  }
  offset += static_cast<std::size_t>(std::max(at.column, 1)) - 1;
  if (offset > text.size()) return std::nullopt;
  return offset;
}

std::size_t Edit::line_begin(std::size_t offset) const {
  const std::size_t end = offset == 0 ? std::string::npos : document_.text.rfind('\n', offset - 1);
  return end == std::string::npos ? 0 : end + 1;
}

std::size_t Edit::line_end(std::size_t offset) const {
  std::size_t end = std::min(document_.text.find('\n', offset), document_.text.size());
  if (end > offset && document_.text[end - 1] == '\r') --end;
  return end;
}

/// Returns the offset of the end of a plain scalar, or of a list of plain scalars in brackets. Returns
/// nothing for other nodes.
std::optional<std::size_t> Edit::end_of(const Node& node) const {
  const std::string& text = document_.text;
  const auto begin = offset_of(text, node.at);
  if (!begin) return std::nullopt;
  if (node.kind == Node::Kind::scalar && !node.quoted &&
      text.compare(*begin, node.scalar.size(), node.scalar) == 0) {
    return *begin + node.scalar.size();
  }
  if (node.kind != Node::Kind::sequence || node.items.empty() || text[*begin] != '[') return std::nullopt;
  std::optional<std::size_t> end = end_of(node.items.back());
  if (!end) return std::nullopt;
  *end = text.find_first_not_of(" \t\r\n,", *end);
  if (*end == std::string::npos || text[*end] != ']') return std::nullopt;
  return *end + 1;
}

bool Edit::replace_numbers(const Node& list, const std::vector<std::string>& numbers) {
  if (list.kind != Node::Kind::sequence || list.items.size() != numbers.size()) return false;
  std::vector<Change> changes;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Node& item = list.items[i];
    const auto begin = offset_of(document_.text, item.at);
    const auto end = item.kind == Node::Kind::scalar ? end_of(item) : std::nullopt;
    if (!begin || !end) return false;
    changes.push_back({*begin, *end - *begin, numbers[i]});
  }
  changes_.insert(changes_.end(), changes.begin(), changes.end());
  return true;
}

bool Edit::add_key(const Node& map, std::string_view key, std::string_view value) {
  if (map.kind != Node::Kind::map || map.entries.empty()) return false;
  const auto begin = offset_of(document_.text, map.at);
  const Node::Entry& last = map.entries.back();
  const auto end = end_of(last.value);
  if (!begin || !end) return false;
  const std::string entry = std::string(key) + ": " + std::string(value);
  if (document_.text[*begin] == '{') {
    changes_.push_back({*end, 0, ", " + entry});
    return true;
  }
  const std::string indent(static_cast<std::size_t>(last.key_at.column - 1), ' ');
  changes_.push_back({line_end(*end), 0, "\n" + indent + entry});
  return true;
}

bool Edit::comment_above(const Node::Entry& entry, std::string_view mark, std::string_view comment) {
  const std::string& text = document_.text;
  const auto at = offset_of(text, entry.key_at);
  if (!at) return false;
  const std::size_t begin = line_begin(*at);
  const std::string indent = text.substr(begin, *at - begin);
  if (indent.find_first_not_of(' ') != std::string::npos) return false;
  if (begin > 0) {
    const std::size_t above = line_begin(begin - 1);
    const std::size_t word = text.find_first_not_of(' ', above);
    if (text.compare(word, mark.size(), mark) == 0) {
      changes_.push_back({word, line_end(word) - word, std::string(comment)});
      return true;
    }
  }
  changes_.push_back({begin, 0, indent + std::string(comment) + "\n"});
  return true;
}

std::string Edit::text() const {
  std::vector<Change> changes = changes_;
  // The changes are applied from the end of the text to its beginning, so that a change does not move the
  // offsets of the changes that remain. Two changes at the same offset keep their order.
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.offset < b.offset; });
  std::string text = document_.text;
  for (auto change = changes.rbegin(); change != changes.rend(); ++change) {
    text.replace(change->offset, change->length, change->text);
  }
  return text;
}

}  // namespace softgrip::document
