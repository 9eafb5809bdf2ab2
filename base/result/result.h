#pragma once
// The result of a command as a tree of fields. A field states its JSON key, its title and its value once, so
// a new field is added in one place. Functions convert the tree to output: json_text() writes the fields that
// have a key. table_of() and terms_of() select the fields that have a title, and text_of() and html_of()
// (table.h) write the selected fields.

#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/result/table.h"

namespace softgrip::result {

struct Field;
using Fields = std::vector<Field>;

/// A value of a field: `json` is written to JSON files, and `text` is shown to readers.
struct Value {
  using List = std::vector<Value>;

  Value() = default;
  Value(bool yes);
  Value(std::signed_integral auto number);
  Value(std::unsigned_integral auto number);
  Value(double number);
  Value(const std::optional<double>& number);
  Value(std::string words);
  Value(std::string_view words);
  Value(const char* words);
  Value(const std::vector<std::string>& items);
  Value(List items);
  Value(Fields fields);

  /// The value in JSON: std::monostate becomes null, and Fields becomes an object.
  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, List, Fields> json;
  std::string text = "-";
  bool numeric = false;  ///< true: the text is right-aligned in a table
};

struct Field {
  Field(std::string key_, Value value_) : key(std::move(key_)), value(std::move(value_)) {}
  Field(std::string key_, std::string title_, Value value_)
      : key(std::move(key_)), title(std::move(title_)), value(std::move(value_)) {}

  std::string key;    ///< key in JSON; empty: the field is not in JSON
  std::string title;  ///< name for a reader; empty: the field is only in JSON
  Value value;
};

// The constructors of Value need the complete type Field.
inline Value::Value(bool yes) : json(yes), text(yes ? "yes" : "no") {}
Value::Value(std::signed_integral auto number)
    : json(std::int64_t{number}), text(std::to_string(number)), numeric(true) {}
Value::Value(std::unsigned_integral auto number)
    : json(std::uint64_t{number}), text(std::to_string(number)), numeric(true) {}
inline Value::Value(std::string words) : json(words), text(std::move(words)) {}
inline Value::Value(std::string_view words) : Value(std::string(words)) {}
inline Value::Value(const char* words) : Value(std::string(words)) {}
inline Value::Value(List items) : json(std::move(items)) {}
inline Value::Value(Fields fields) : json(std::move(fields)) {}

/// Calls fields_of() from the namespace of the item.
inline constexpr auto fields_of_item = [](const auto& item) { return fields_of(item); };

/// Returns a number whose text has `digits` significant digits and, after a blank, the unit. A number that is
/// absent or not finite is null in JSON and "-" as text.
[[nodiscard]] Value number(const std::optional<double>& value, int digits = 4, std::string_view unit = {});
/// Returns a number whose text has `decimals` digits after the point.
[[nodiscard]] Value decimals(double value, int decimals);
/// Returns the value with its text replaced by `text`.
/// @param numeric  true: the text is right-aligned in a table.
[[nodiscard]] Value shown(Value value, std::string text, bool numeric = false);
/// Returns a value with this text. If the text is empty, the value is null in JSON.
[[nodiscard]] Value or_null(std::string text);
/// Returns the value of an optional item. If there is no item, the value is null in JSON. The function
/// `to_value` returns the value of an item.
template <class Item, class ToValue = decltype(fields_of_item)>
[[nodiscard]] Value or_null(const std::optional<Item>& item, const ToValue& to_value = {}) {
  return item ? Value(std::invoke(to_value, *item)) : Value();
}

/// Returns an object with one entry for each pair of a key and a value.
template <class Pairs>
[[nodiscard]] Fields keyed(const Pairs& pairs) {
  Fields fields;
  for (const auto& [key, value] : pairs) fields.emplace_back(std::string(key), Value(value));
  return fields;
}

/// Returns an array with one element for each item. The function `to_value` returns the element for an item.
template <std::ranges::range Items, class ToValue = decltype(fields_of_item)>
[[nodiscard]] Value list_of(const Items& items, const ToValue& to_value = {}) {
  Value::List list;
  for (const auto& item : items) list.emplace_back(std::invoke(to_value, item));
  return list;
}

/// Returns a table with one column for each titled field of `columns` and one row for each element of `rows`.
/// Every row has the titled fields of `columns`, in the same order.
[[nodiscard]] Table table_of(std::string caption, const Fields& columns, const std::vector<Fields>& rows);

/// Returns a table with one row for each item. The function `to_fields` returns the fields of the row for an
/// item.
template <std::ranges::range Items, class ToFields = decltype(fields_of_item)>
[[nodiscard]] Table table_of(std::string caption, const Items& items, const ToFields& to_fields = {}) {
  std::vector<Fields> rows;
  for (const auto& item : items) rows.push_back(std::invoke(to_fields, item));
  const Fields columns =
      rows.empty() ? std::invoke(to_fields, std::ranges::range_value_t<Items>{}) : rows.front();
  return table_of(std::move(caption), columns, rows);
}

/// Returns the titles and the texts of the fields that have a title. If the value of a field without a title
/// is an object, the terms of the object are returned in its place.
[[nodiscard]] Terms terms_of(const Fields& fields);

/// Returns the value as JSON. A number that is not finite is null.
[[nodiscard]] nlohmann::ordered_json json_of(const Value& value);
/// Returns the fields as the text of a JSON file. If two fields have the same key, the second value is
/// written at the position of the first one. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string json_text(const Fields& fields);

}  // namespace softgrip::result
