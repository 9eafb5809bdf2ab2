#pragma once
// Changes a document's text without changing its comments and layout.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/node.h"

namespace softgrip::document {

/// Returns the entry of a map under a key. Returns nullptr if the map has no such key, or if `node` is
/// nullptr or not a map.
[[nodiscard]] const Node::Entry* entry_of(const Node* node, std::string_view key) noexcept;
/// Returns the node at which the keys of `path` end, starting at `node`; nullptr if a key does not exist.
[[nodiscard]] const Node* below(const Node* node, const std::vector<std::string_view>& path) noexcept;

/// Returns the byte offset of a location in the text. Returns nothing if the location is beyond the end of
/// the text.
[[nodiscard]] std::optional<std::size_t> offset_of(std::string_view text, Location at) noexcept;

/// Collects changes of a text and applies them together. If a function does not support the layout of the
/// text, it returns false and adds no change.
class Edit {
 public:
  explicit Edit(const Document& document) : document_(document) {}

  /// Replaces all numbers of a list by the numbers in `numbers`, in the same order.
  bool replace_numbers(const Node& list, const std::vector<std::string>& numbers);
  /// Adds a key at the end of a map. In a flow map, the new key is on the line of the last entry; in a block
  /// map, it gets a line of its own. The value of the last entry must be a plain word, a number, or a list of
  /// plain words or numbers in brackets.
  bool add_key(const Node& map, std::string_view key, std::string_view value);
  /// Adds a comment on a line of its own above the line of `entry`. If the line above `entry` is a comment
  /// that begins with `mark`, the new comment replaces this comment. Returns false if other text precedes
  /// `entry` on its line.
  bool comment_above(const Node::Entry& entry, std::string_view mark, std::string_view comment);

  /// Returns the text with all collected changes.
  [[nodiscard]] std::string text() const;

 private:
  struct Change {
    std::size_t offset;
    std::size_t length;
    std::string text;
  };
  [[nodiscard]] std::optional<std::size_t> end_of(const Node& node) const;
  [[nodiscard]] std::size_t line_begin(std::size_t offset) const;
  [[nodiscard]] std::size_t line_end(std::size_t offset) const;

  const Document& document_;
  std::vector<Change> changes_;
};

}  // namespace softgrip::document
