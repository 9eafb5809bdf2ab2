#include "base/result/result.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "base/numbers.h"
#include "base/text.h"

namespace softgrip::result {
namespace {

using Json = nlohmann::ordered_json;

/// Functions that convert each alternative of Value::json to JSON.
struct ToJson {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(double number) const { return std::isfinite(number) ? Json(number) : Json(nullptr); }
  Json operator()(const auto& plain) const { return plain; }
  Json operator()(const Value::List& items) const {
    Json list = Json::array();
    for (const Value& item : items) list.push_back(json_of(item));
    return list;
  }
  Json operator()(const Fields& fields) const {
    Json object = Json::object();
    for (const Field& field : fields) {
      if (!field.key.empty()) object[field.key] = json_of(field.value);
    }
    return object;
  }
};

}  // namespace

Value::Value(double number) : json(number), text(significant(number)), numeric(true) {}

Value::Value(const std::optional<double>& number) : numeric(true) {
  if (number) *this = Value(*number);
}

Value::Value(const std::vector<std::string>& items)
    : json(List(items.begin(), items.end())), text(items.empty() ? "-" : with_commas(items)) {}

Value number(const std::optional<double>& value, int digits, std::string_view unit) {
  Value shown(value);
  if (value && std::isfinite(*value))
    shown.text = significant(*value, digits) + (unit.empty() ? "" : " ") + std::string(unit);
  return shown;
}

Value decimals(double value, int decimals) {
  Value shown(value);
  shown.text = fixed(value, decimals);
  return shown;
}

Value shown(Value value, std::string text, bool numeric) {
  value.text = std::move(text);
  value.numeric = numeric;
  return value;
}

Value or_null(std::string text) {
  return text.empty() ? shown({}, "") : Value(std::move(text));
}

Table table_of(std::string caption, const Fields& columns, const std::vector<Fields>& rows) {
  Table table{std::move(caption), {}, {}, {}};
  for (const Field& column : columns) {
    if (column.title.empty()) continue;
    table.header.push_back(column.title);
    table.numeric.push_back(column.value.numeric);
  }
  for (const Fields& row : rows) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    for (const auto& [title, text] : terms_of(row)) cells.push_back(text);
  }
  return table;
}

Terms terms_of(const Fields& fields) {
  Terms terms;
  for (const Field& field : fields) {
    if (!field.title.empty()) {
      terms.emplace_back(field.title, field.value.text);
    } else if (const auto* inner = std::get_if<Fields>(&field.value.json)) {
      for (auto& term : terms_of(*inner)) terms.push_back(std::move(term));
    }
  }
  return terms;
}

Json json_of(const Value& value) {
  return std::visit(ToJson{}, value.json);
}

std::string json_text(const Fields& fields) {
  return json_dump(json_of(fields), 2) + "\n";
}

}  // namespace softgrip::result
