#pragma once
// Changes in a document's text that leave its comments and its layout as they are.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/node.h"

namespace softgrip::document {

/// The entry of a map under a key, or nullptr: also where `node` is nullptr or no map.
[[nodiscard]] const Node::Entry* entry_of(const Node* node, std::string_view key) noexcept;
/// The node below `node` along `path`, or nullptr.
[[nodiscard]] const Node* below(const Node* node, const std::vector<std::string_view>& path) noexcept;

/// Returns the byte offset of a location in the text; empty beyond its end.
[[nodiscard]] std::optional<std::size_t> offset_of(std::string_view text, Location at) noexcept;

/// Collects changes and makes them at once. Every function returns false, and changes nothing, where the text
/// is not written in a way that it understands.
class Edit {
 public:
  explicit Edit(const Document& document) : document_(document) {}

  /// Replaces the numbers of a list, each in place.
  bool replace_numbers(const Node& list, const std::vector<std::string>& numbers);
  /// One more key at the end of a map: behind its last entry in a flow map, on a line of its own in a block
  /// map. The last entry must be a plain word, a number or a list of them in brackets.
  bool add_key(const Node& map, std::string_view key, std::string_view value);
  /// A comment on a line of its own above the line on which `entry` begins, in the place of one there that
  /// begins with `mark`. False where the entry does not begin its line.
  bool comment_above(const Node::Entry& entry, std::string_view mark, std::string_view comment);

  /// The text with all changes.
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
