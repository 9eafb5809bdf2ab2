#pragma once
// Typed, bounded access to a parsed document. Every key that is not read is reported as unknown.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/node.h"

namespace softgrip::document {

/// The allowed range of a number; both ends belong to it. Not finite is never allowed.
struct Range {
  double lower = -std::numeric_limits<double>::max();
  double upper = std::numeric_limits<double>::max();
};

/// Reads one map. Each getter notes its key as known; finish() reports all others with the nearest known
/// name, and recognises a known name that lacks its unit (`delay` for `delay_s`) or carries another one
/// (`delay_ms`); a required key that is missing is reported there too, unless an unknown one explains it.
/// Getters never throw: they add a problem and return a harmless value, so that all errors of a document are
/// found in one pass.
class MapReader {
 public:
  /// `what` names the map in messages ("channel 'left'"). A node that is no map is reported once.
  MapReader(const Document& document, const Node& node, Problems& problems, std::string what);
  MapReader(const MapReader&) = delete;
  MapReader& operator=(const MapReader&) = delete;
  MapReader(MapReader&&) = delete;
  MapReader& operator=(MapReader&&) = delete;
  /// Calls finish() if the caller did not.
  ~MapReader();

  /// A required number in `range`. Missing, not a number, not finite or out of range: a problem, and
  /// the nearest allowed value (or 0 clamped to the range) is returned.
  double number(std::string_view key, Range range);
  /// Reads a number in `range` under a key that may be absent. A wrong value is a problem, as for number().
  std::optional<double> optional_number(std::string_view key, Range range);
  /// A required whole number in [lower, upper].
  std::int64_t integer(std::string_view key, std::int64_t lower, std::int64_t upper);
  std::optional<std::int64_t> optional_integer(std::string_view key, std::int64_t lower, std::int64_t upper);
  /// `true` or `false`, nothing else.
  bool boolean(std::string_view key);
  std::optional<bool> optional_boolean(std::string_view key);
  /// A text of one line that is not empty.
  std::string text(std::string_view key);
  std::optional<std::string> optional_text(std::string_view key);
  /// One of `choices`; returns its index (0 when there was a problem).
  std::size_t choice(std::string_view key, const std::vector<std::string>& choices);
  std::optional<std::size_t> optional_choice(std::string_view key, const std::vector<std::string>& choices);
  /// The node under a key, whatever its kind (nullptr when absent; `required` makes that a problem).
  const Node* child(std::string_view key, bool required);
  /// The items of a sequence under a key (empty when absent; `required` makes that a problem).
  std::vector<const Node*> sequence(std::string_view key, bool required);
  /// A required list of `count` numbers in `range`, as `at_v: [0, 10]`. Always returns `count` numbers.
  std::vector<double> numbers(std::string_view key, std::size_t count, Range range);
  std::optional<std::vector<double>> optional_numbers(std::string_view key, std::size_t count, Range range);

  /// Returns true if the map contains the key. Does not count as reading it.
  [[nodiscard]] bool has(std::string_view key) const;
  /// True if the key stands in the map and its getter found nothing wrong: what a check of several keys
  /// together asks first.
  [[nodiscard]] bool good(std::string_view key) const;
  /// All keys in the order of the text.
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Returns the location of a key, or of the map itself.
  [[nodiscard]] Location where(std::string_view key) const;
  /// A problem of meaning that only the caller can see, at a key's value.
  void report(std::string_view key, std::string message, std::string hint = {});
  /// Reports a warning at a key's value: the value is permitted but probably not meant.
  void warn(std::string_view key, std::string message, std::string hint = {});
  /// Reports keys that nobody asked for and those that are missing. Further getters must not be called.
  void finish();

 private:
  const Node::Entry* find(std::string_view key);
  const Node* need(std::string_view key);
  void refuse(const Node& value, std::string_view key, const std::string& message, std::string hint);
  double checked(std::string_view key, const Node* value, Range range);
  std::int64_t checked_integer(std::string_view key, const Node* value, std::int64_t lower,
                               std::int64_t upper);
  bool checked_boolean(std::string_view key, const Node* value);
  std::string checked_text(std::string_view key, const Node* value);
  std::size_t checked_choice(std::string_view key, const Node* value,
                             const std::vector<std::string>& choices);
  std::vector<double> checked_numbers(std::string_view key, const Node* value, std::size_t count,
                                      Range range);
  void report_unknown(const Node::Entry& entry);

  const Document& document_;
  const Node& node_;
  Problems& problems_;
  std::string what_;
  std::vector<std::string> known_;
  std::vector<std::string> missing_;
  std::vector<std::string> bad_;  // keys whose value was refused
  bool finished_ = false;
};

/// The number in a scalar node, within `range`, or a problem and nothing.
[[nodiscard]] std::optional<double> number_in(const Document& document, const Node& node, Range range,
                                              Problems& problems, std::string_view what);

}  // namespace softgrip::document
