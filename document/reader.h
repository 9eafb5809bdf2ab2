#pragma once
// Reads the values of a parsed document and checks their types and ranges. Reports each key that was not read
// as unknown.
// Finds the known key that the user probably meant by an unknown key.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/enum_table.h"
#include "document/node.h"

namespace softgrip::document {

/// The allowed range of a number, including both ends. Infinity and NaN are never allowed.
struct Range {
  double lower = -std::numeric_limits<double>::max();
  double upper = std::numeric_limits<double>::max();
};

/// Returns a range as text: "at least 0", "at most 10", "0 to 10" or "only 1".
[[nodiscard]] std::string text_of(Range range);

/// Reads one map. Each getter marks its key as known. finish() reports all other keys as unknown, together
/// with the most similar known key. This known key may be the unknown key with a unit (`delay_s` for `delay`)
/// or with another unit (`delay_s` for `delay_ms`). finish() also reports each missing key, except a key that
/// is the probable meaning of an unknown key. Getters do not throw. After a problem, a getter returns a
/// harmless value, so that all errors of a document are found together.
class MapReader {
 public:
  /// `what` is the name of the map in messages ("channel 'left'"). If the node is not a map, exactly one
  /// problem is reported.
  MapReader(const Document& document, const Node& node, Problems& problems, std::string what);
  MapReader(const MapReader&) = delete;
  MapReader& operator=(const MapReader&) = delete;
  MapReader(MapReader&&) = delete;
  MapReader& operator=(MapReader&&) = delete;
  /// Calls finish() if it has not been called yet.
  ~MapReader();

  /// Returns a reader of another map of the same document.
  [[nodiscard]] MapReader inner(const Node& node, std::string what) const {
    return {document_, node, problems_, std::move(what)};
  }

  /// Reads a required number in `range`. Adds a problem if the number is missing, not finite or out of range,
  /// or if the value is not a number. After a problem, returns the nearest allowed value, or 0 limited to the
  /// range if there is no number.
  double number(std::string_view key, Range range);
  /// Reads a number in `range` under a key that may be absent. number() describes the result for a wrong
  /// value.
  std::optional<double> optional_number(std::string_view key, Range range) {
    return given(key) ? std::optional(number(key, range)) : std::nullopt;
  }
  /// Reads a required whole number in `range`, whose ends must be whole numbers if they are given.
  std::int64_t integer(std::string_view key, Range range);
  std::optional<std::int64_t> optional_integer(std::string_view key, Range range) {
    return given(key) ? std::optional(integer(key, range)) : std::nullopt;
  }
  /// Reads a truth value: `true` or `false`. No other words are accepted.
  bool boolean(std::string_view key);
  std::optional<bool> optional_boolean(std::string_view key) {
    return given(key) ? std::optional(boolean(key)) : std::nullopt;
  }
  /// Reads a text of one line that is not empty.
  std::string text(std::string_view key);
  std::optional<std::string> optional_text(std::string_view key) {
    return given(key) ? std::optional(text(key)) : std::nullopt;
  }
  /// Reads one of the texts in `choices` and returns the index of this text. After a problem, returns 0.
  std::size_t choice(std::string_view key, const std::vector<std::string>& choices);
  std::optional<std::size_t> optional_choice(std::string_view key, const std::vector<std::string>& choices) {
    return given(key) ? std::optional(choice(key, choices)) : std::nullopt;
  }
  /// Reads one of the names of an enum and returns its value. After a problem, returns the first value.
  template <class Enum, std::size_t count>
  Enum choice(std::string_view key, const EnumTable<Enum, std::string_view, count>& names) {
    return static_cast<Enum>(choice(key, names.names()));
  }
  /// Returns the node under a key; the node may be of any kind. Returns nullptr if the key is absent, and
  /// reports a problem in this case if `required` is true.
  const Node* child(std::string_view key, bool required);
  /// Returns the items of a sequence under a key. Returns an empty list if the key is absent, and reports a
  /// problem in this case if `required` is true.
  std::vector<const Node*> sequence(std::string_view key, bool required);
  /// Reads a required list of `count` numbers in `range`, for example `at_v: [0, 10]`. The result always has
  /// `count` numbers, also after a problem.
  std::vector<double> numbers(std::string_view key, std::size_t count, Range range);
  std::optional<std::vector<double>> optional_numbers(std::string_view key, std::size_t count, Range range) {
    return given(key) ? std::optional(numbers(key, count, range)) : std::nullopt;
  }

  /// Returns true if the map contains the key. This call does not mark the key as known.
  [[nodiscard]] bool has(std::string_view key) const;
  /// Returns true if the map contains the key and its getter found no problem. Call good() before a check
  /// that combines the values of several keys.
  [[nodiscard]] bool good(std::string_view key) const;
  /// Returns all keys of the map in the order of the text.
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Returns the name under which the map contains a value that has a deprecated name: `deprecated` if the
  /// map contains this name and not `key`, otherwise `key`. The caller reads the value under the returned
  /// name. Reports a problem if the map contains both names. An empty `deprecated` means that there is no
  /// such name.
  [[nodiscard]] std::string_view name_in_use(std::string_view key, std::string_view deprecated);
  /// Returns the location of a key, or the location of the map if it does not contain the key.
  [[nodiscard]] Location where(std::string_view key) const;
  /// Reports a problem with the value of a key. The caller uses this function for problems that no getter
  /// detects.
  void report(std::string_view key, std::string message, std::string hint = {});
  /// Reports a problem at a location, for example the location of an item of a list.
  void report(Location at, std::string message, std::string hint = {}) {
    problems_.add(document_.problem(at, std::move(message), std::move(hint)));
  }
  /// Reports a warning about the value of a key that is permitted but probably not meant.
  void warn(std::string_view key, std::string message, std::string hint = {});
  /// Reports keys that were not read and required keys that are missing. No getter may be called after
  /// finish().
  void finish();

 private:
  const Node::Entry* find(std::string_view key);
  bool given(std::string_view key) { return find(key) != nullptr; }
  const Node* need(std::string_view key);
  void refuse(const Node& value, std::string_view key, const std::string& message, std::string hint);
  double checked(std::string_view key, const Node* value, Range range);
  void report_unknown(const Node::Entry& entry);

  const Document& document_;
  const Node& node_;
  Problems& problems_;
  std::string what_;
  std::vector<std::string> known_;
  std::vector<std::string> missing_;
  std::vector<std::string> bad_;  // keys of the map whose value was refused
  bool finished_ = false;
};

/// Returns the number in a scalar node if the number is within `range`. Otherwise, adds a problem and returns
/// nothing.
[[nodiscard]] std::optional<double> number_in(const Document& document, const Node& node, Range range,
                                              Problems& problems, std::string_view what);

/// The known key that the user probably meant by an unknown key, and a hint for the message. Both texts are
/// empty if no known key is similar.
struct KeyHint {
  std::string key;
  std::string hint;
};

/// Returns the known key that the user probably meant, and a hint for the message.
/// @param key    the unknown key
/// @param value  the value of the unknown key
/// @param known  permitted keys that the map does not contain
[[nodiscard]] KeyHint hint_for_key(std::string_view key, const Node& value,
                                   const std::vector<std::string>& known);

/// Returns the unit at the end of a key: "kpa" for `squeeze_kpa`, "mm_per_s" for `speed_mm_per_s`. Returns an
/// empty text if the key does not end with a unit of the project.
[[nodiscard]] std::string_view unit_at_end(std::string_view key);

/// Returns a hint for a number out of range, such as "the unit is seconds: 130 ms would be 0.13". There is a
/// hint if the number would be in range after a conversion from a related unit to the unit of `key`.
/// Otherwise, the text is empty.
[[nodiscard]] std::string hint_for_range(std::string_view key, double value, double lower, double upper);

}  // namespace softgrip::document
