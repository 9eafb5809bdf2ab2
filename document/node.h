#pragma once
// Defines a parsed YAML document as plain values with their locations. Only a part of YAML is accepted: see
// parse().
// Converts texts to numbers. A number must be a plain decimal number; the locale has no effect. For any other
// text, the result contains the reason of the refusal.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"

namespace softgrip::document {

/// Upper limits for a document. A document that exceeds a limit is refused before reading it takes much time
/// or memory.
struct Bounds {
  std::size_t bytes = 256 * 1024;
  std::size_t nodes = 20'000;
  int depth = 12;
};

/// A node of the tree: a scalar, a sequence or a map, with its location in the text.
struct Node {
  enum class Kind { null, scalar, sequence, map };
  struct Entry;

  Kind kind = Kind::null;
  Location at;
  std::string scalar;       ///< text of a scalar, without its quotes
  bool quoted = false;      ///< true: the scalar was quoted, so it is a text and never a number
  std::string stands_for;   ///< name of the parameter, if the file contains `$` and this name in place of the
                            ///< value; otherwise empty
  bool refused = false;     ///< true: the node is not checked again, because one of its problems was already
                            ///< reported or because the node is truncated
  std::vector<Node> items;  ///< items of a sequence node
  std::vector<Entry> entries;  ///< entries of a map in the order of the text, with unique keys
};
struct Node::Entry {
  std::string key;
  Location key_at;
  Node value;
};

/// A document: its name for messages, its text and its root node.
struct Document {
  std::string file;
  std::string text;
  Node root;
  /// false: parsing stopped before the end of the text. Readers then do not report missing keys, because
  /// these keys may be in the unread part.
  bool complete = true;

  /// Returns a problem at the location `at`. The problem contains the text of the line at `at`.
  [[nodiscard]] Problem problem(Location at, std::string message, std::string hint = {}) const;
};

/// Parses one YAML document. Adds a problem at the location of each of the following: anchors, aliases, tags,
/// merge keys, duplicate keys, keys that are not a plain word, directives, several documents, exceeded
/// `bounds`, bytes that are not UTF-8, control characters, tabs as indentation and syntax errors. Returns the
/// readable part of the document. If a key occurs twice, the result contains the first entry. An alias is
/// refused and has no value.
[[nodiscard]] Document parse(std::string file, std::string text, Problems& problems,
                             const Bounds& bounds = {});

/// Reads a complete file of at most `bounds.bytes` and parses it. If the file cannot be read, adds a problem
/// at line 1, column 1.
[[nodiscard]] Document parse_file(const std::string& path, Problems& problems, const Bounds& bounds = {});

/// A number, or the reason why the text is not a number. Exactly one of `value` and `message` is present.
template <class T>
struct Parsed {
  std::optional<T> value;
  std::string message;  ///< message that follows the key: "must be a number, found `fast`"
  std::string hint;
};

/// Reads a decimal number: [+-]digits[.digits][e[+-]digits]. At least one digit must precede the exponent,
/// and leading zeros are an error.
[[nodiscard]] Parsed<double> parse_number(const Node& node);
/// Reads a whole number: [+-]digits. Leading zeros are an error.
[[nodiscard]] Parsed<std::int64_t> parse_integer(const Node& node);
/// Reads a truth value: `true` or `false`.
[[nodiscard]] Parsed<bool> parse_boolean(const Node& node);

/// Returns "the decimal mark is a point: 0.5" if the comma between two nodes of one line was probably meant
/// as a decimal mark. Examples are `[0,5]` and `{hold_s: 0,5}`. Otherwise returns an empty text. `after` is
/// the location after the comma.
[[nodiscard]] std::string hint_for_comma(const Node& before, Location after, std::string_view text_after);

/// Returns a description of a node that follows "found" in a message: "a list", "a map", "nothing" or
/// "`text`".
[[nodiscard]] std::string found(const Node& node);

}  // namespace softgrip::document
