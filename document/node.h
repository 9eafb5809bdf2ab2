#pragma once
// A parsed YAML document as plain located values. Parsing is strict: see parse().

#include <cstddef>
#include <string>
#include <vector>

#include "document/problem.h"

namespace softgrip::document {

/// Bounds on what a document may be; beyond them it is refused before it can cost anything.
struct Bounds {
  std::size_t bytes = 256 * 1024;
  std::size_t nodes = 20'000;
  int depth = 12;
};

/// A node of the tree: a scalar, a sequence or a map, with its place in the text.
struct Node {
  enum class Kind { null, scalar, sequence, map };
  struct Entry;

  Kind kind = Kind::null;
  Location at;
  std::string scalar;          ///< the text of a scalar, unquoted
  bool quoted = false;         ///< the scalar was quoted: a string, never a number
  std::string stands_for;      ///< `$name` if the file has it in place of the number of the scalar; or empty
  bool refused = false;        ///< already reported or truncated: present, not to be checked again
  std::vector<Node> items;     ///< of a sequence
  std::vector<Entry> entries;  ///< of a map, in the order of the text, keys unique
};
struct Node::Entry {
  std::string key;
  Location key_at;
  Node value;
};

/// A document: its name for messages, its text, its root.
struct Document {
  std::string file;
  std::string text;
  Node root;
  /// False if parsing stopped before the end. A missing key may then be further down, so readers do not
  /// report it.
  bool complete = true;

  /// A problem at `at`, with the line's text filled in.
  [[nodiscard]] Problem problem(Location at, std::string message, std::string hint = {}) const;
};

/// Parses one YAML document. Refused, each with its place: anchors, aliases, tags, merge keys, duplicate
/// keys, keys that are no plain word, directives, more than one document, anything beyond `bounds`, bytes
/// that are not UTF-8, control characters, tabs as indentation, syntax errors. Problems are added to
/// `problems`; the document is returned all the same, with what could be read: of a duplicate key the first,
/// of a refused alias nothing.
[[nodiscard]] Document parse(std::string file, std::string text, Problems& problems,
                             const Bounds& bounds = {});

/// Reads a whole file of at most `bounds.bytes` and parses it. A file that cannot be read is a problem at
/// 1:1.
[[nodiscard]] Document parse_file(const std::string& path, Problems& problems, const Bounds& bounds = {});

}  // namespace softgrip::document
