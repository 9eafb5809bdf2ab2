#include "document/reader.h"

#include <algorithm>

#include "base/numbers.h"
#include "base/text.h"
#include "document/node.h"
#include "document/problem.h"

namespace softgrip::document {

namespace {

double harmless(Range range) {
  return std::clamp(0.0, range.lower, range.upper);
}

bool has_control(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(character_length(text), 1);
    if (is_control(text.substr(0, length))) return true;
    text.remove_prefix(length);
  }
  return false;
}

std::string not_a_map_hint(const Node& node) {
  if (node.kind == Node::Kind::sequence) return "remove the `- ` or `[ ]` if there is only one item";
  if (node.kind == Node::Kind::scalar && !node.quoted && node.scalar.find(':') != std::string::npos) {
    return "a space is missing after the colon";
  }
  return {};
}

std::string listed(const std::vector<std::string>& choices) {
  return enumerated(choices, " or ", in_backticks);
}

}  // namespace

std::string text_of(Range range) {
  if (range.lower == Range{}.lower) return "at most " + written(range.upper);
  if (range.upper == Range{}.upper) return "at least " + written(range.lower);
  if (range.lower == range.upper) return "only " + written(range.lower);
  return written(range.lower) + " to " + written(range.upper);
}

MapReader::MapReader(const Document& document, const Node& node, Problems& problems, std::string what)
    : document_(document), node_(node), problems_(problems), what_(std::move(what)) {
  if (node.kind == Node::Kind::map) return;
  finished_ = true;
  if (node.refused || (node.kind == Node::Kind::null && !document.complete)) return;
  problems.add(document.problem(node.at, what_ + " must be a map of keys, found " + found(node),
                                not_a_map_hint(node)));
}

MapReader::~MapReader() {
  finish();
}

const Node::Entry* MapReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  const auto entry = std::find_if(node_.entries.begin(), node_.entries.end(),
                                  [&](const Node::Entry& e) { return e.key == key; });
  return entry == node_.entries.end() ? nullptr : &*entry;
}

const Node* MapReader::need(std::string_view key) {
  const Node::Entry* const entry = find(key);
  if (entry == nullptr && std::find(missing_.begin(), missing_.end(), key) == missing_.end())
    missing_.emplace_back(key);
  return entry == nullptr ? nullptr : &entry->value;
}

void MapReader::refuse(const Node& value, std::string_view key, const std::string& message,
                       std::string hint) {
  bad_.emplace_back(key);
  problems_.add(document_.problem(value.at, in_backticks(key) + " " + message, std::move(hint)));
}

double MapReader::checked(std::string_view key, const Node* value, Range range) {
  if (value == nullptr || value->refused) return harmless(range);
  Parsed<double> number = parse_number(*value);
  if (!number.value) {
    refuse(*value, key, number.message, std::move(number.hint));
    return harmless(range);
  }
  if (*number.value < range.lower || *number.value > range.upper) {
    const std::string whose = value->stands_for.empty() ? "" : " (" + in_backticks(value->stands_for) + ")";
    refuse(*value, key, "is " + written(*number.value) + whose + ", allowed is " + text_of(range),
           hint_for_range(key, *number.value, range.lower, range.upper));
  }
  return std::clamp(*number.value, range.lower, range.upper);
}

double MapReader::number(std::string_view key, Range range) {
  return checked(key, need(key), range);
}

std::int64_t MapReader::integer(std::string_view key, Range range) {
  const Node* const value = need(key);
  const auto fallback = static_cast<std::int64_t>(harmless(range));
  if (value == nullptr || value->refused) return fallback;
  Parsed<std::int64_t> number = parse_integer(*value);
  if (!number.value) {
    refuse(*value, key, number.message, std::move(number.hint));
    return fallback;
  }
  const auto compared = static_cast<double>(*number.value);
  if (compared >= range.lower && compared <= range.upper) return *number.value;
  refuse(*value, key, "is " + std::to_string(*number.value) + ", allowed is " + text_of(range), "");
  return static_cast<std::int64_t>(std::clamp(compared, range.lower, range.upper));
}

bool MapReader::boolean(std::string_view key) {
  const Node* const value = need(key);
  if (value == nullptr || value->refused) return false;
  Parsed<bool> flag = parse_boolean(*value);
  if (!flag.value) refuse(*value, key, flag.message, std::move(flag.hint));
  return flag.value.value_or(false);
}

std::string MapReader::text(std::string_view key) {
  const Node* const value = need(key);
  if (value == nullptr || value->refused) return {};
  if (value->kind != Node::Kind::scalar || value->scalar.empty() || !value->stands_for.empty()) {
    refuse(*value, key, "must be a text, found " + found(*value), "");
    return {};
  }
  if (has_control(value->scalar)) {
    refuse(*value, key, "must be one line without control characters, found " + found(*value),
           "start a text of several lines with `>-`");
    return {};
  }
  return value->scalar;
}

std::size_t MapReader::choice(std::string_view key, const std::vector<std::string>& choices) {
  const Node* const value = need(key);
  if (value == nullptr || value->refused) return 0;
  const auto choice = std::find(choices.begin(), choices.end(), value->scalar);
  if (value->kind == Node::Kind::scalar && choice != choices.end()) {
    return static_cast<std::size_t>(choice - choices.begin());
  }
  const std::string near = value->kind == Node::Kind::scalar ? nearest(value->scalar, choices) : "";
  refuse(*value, key, "must be " + listed(choices) + ", found " + found(*value),
         near.empty() ? "" : "did you mean " + in_backticks(near) + "?");
  return 0;
}

const Node* MapReader::child(std::string_view key, bool required) {
  if (required) return need(key);
  const Node::Entry* const entry = find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

std::vector<const Node*> MapReader::sequence(std::string_view key, bool required) {
  std::vector<const Node*> items;
  const Node* const value = child(key, required);
  if (value == nullptr) return items;
  if (value->refused) return items;
  if (value->kind != Node::Kind::sequence) {
    refuse(*value, key, "must be a list, found " + found(*value), "put `- ` before each item");
    return items;
  }
  for (const Node& item : value->items) items.push_back(&item);
  return items;
}

std::vector<double> MapReader::numbers(std::string_view key, std::size_t count, Range range) {
  const Node* const value = need(key);
  std::vector<double> result(count, harmless(range));
  if (value == nullptr || value->refused) return result;
  const std::string wanted = "must be a list of " + std::to_string(count) + " numbers, found ";
  if (value->kind != Node::Kind::sequence) {
    refuse(*value, key, wanted + found(*value), "");
    return result;
  }
  if (value->items.size() != count) {
    std::string hint;
    for (std::size_t i = 1; i < value->items.size() && hint.empty(); ++i) {
      const Node& item = value->items[i];
      hint = hint_for_comma(value->items[i - 1], item.at, item.scalar);
    }
    refuse(*value, key, wanted + std::to_string(value->items.size()), std::move(hint));
  }
  for (std::size_t i = 0; i < std::min(count, value->items.size()); ++i) {
    result[i] = checked(key, &value->items[i], range);
  }
  return result;
}

bool MapReader::has(std::string_view key) const {
  return std::any_of(node_.entries.begin(), node_.entries.end(),
                     [&](const Node::Entry& entry) { return entry.key == key; });
}

bool MapReader::good(std::string_view key) const {
  if (std::find(bad_.begin(), bad_.end(), key) != bad_.end()) return false;
  return std::any_of(node_.entries.begin(), node_.entries.end(),
                     [&](const Node::Entry& entry) { return entry.key == key && !entry.value.refused; });
}

std::vector<std::string> MapReader::keys() const {
  std::vector<std::string> result;
  result.reserve(node_.entries.size());
  for (const Node::Entry& entry : node_.entries) result.push_back(entry.key);
  return result;
}

std::string_view MapReader::name_in_use(std::string_view key, std::string_view deprecated) {
  if (deprecated.empty() || !has(deprecated)) return key;
  if (!has(key)) return deprecated;
  bad_.emplace_back(key);
  problems_.add(document_.problem(find(deprecated)->key_at,
                                  in_backticks(deprecated) + " is the deprecated name of " +
                                      in_backticks(key) + ", but " + what_ + " contains both keys",
                                  "remove " + in_backticks(deprecated)));
  return key;
}

Location MapReader::where(std::string_view key) const {
  for (const Node::Entry& entry : node_.entries) {
    if (entry.key == key) return entry.key_at;
  }
  return node_.at;
}

void MapReader::report(std::string_view key, std::string message, std::string hint) {
  const Node::Entry* const entry = find(key);
  bad_.emplace_back(key);
  problems_.add(
      document_.problem(entry == nullptr ? node_.at : entry->value.at, std::move(message), std::move(hint)));
}

void MapReader::warn(std::string_view key, std::string message, std::string hint) {
  const Node::Entry* const entry = find(key);
  problems_.warn(
      document_.problem(entry == nullptr ? node_.at : entry->value.at, std::move(message), std::move(hint)));
}

void MapReader::report_unknown(const Node::Entry& entry) {
  // The user cannot have meant a key that the map already contains, so the candidates are the missing keys
  // and the keys that may be absent.
  std::vector<std::string> candidates = missing_;
  for (const std::string& key : known_) {
    if (!has(key) && std::find(missing_.begin(), missing_.end(), key) == missing_.end()) {
      candidates.push_back(key);
    }
  }
  KeyHint hint = hint_for_key(entry.key, entry.value, candidates);
  if (&entry != node_.entries.data()) {
    std::string comma = hint_for_comma((&entry - 1)->value, entry.key_at, entry.key);
    if (!comma.empty()) hint = {"", std::move(comma)};
  }
  // The unknown key explains why the key of the hint is missing. This key is removed from the missing keys,
  // so that one mistake is not reported twice.
  std::erase(missing_, hint.key);
  if (hint.hint.empty() && !known_.empty() && known_.size() <= 12)
    hint.hint = "known here: " + listed(known_);
  problems_.add(document_.problem(entry.key_at, "unknown key " + in_backticks(entry.key) + " in " + what_,
                                  std::move(hint.hint)));
}

void MapReader::finish() {
  if (finished_) return;
  finished_ = true;
  for (const Node::Entry& entry : node_.entries) {
    if (problems_.full()) return;
    if (std::find(known_.begin(), known_.end(), entry.key) == known_.end()) report_unknown(entry);
  }
  if (!document_.complete || node_.refused) return;
  for (const std::string& key : missing_) {
    problems_.add(document_.problem(node_.at, what_ + " lacks the key " + in_backticks(key)));
  }
}

std::optional<double> number_in(const Document& document, const Node& node, Range range, Problems& problems,
                                std::string_view what) {
  if (node.refused) return std::nullopt;
  Parsed<double> number = parse_number(node);
  if (!number.value) {
    problems.add(document.problem(node.at, std::string(what) + " " + number.message, std::move(number.hint)));
    return std::nullopt;
  }
  if (*number.value < range.lower || *number.value > range.upper) {
    problems.add(document.problem(
        node.at, std::string(what) + " is " + written(*number.value) + ", allowed is " + text_of(range),
        hint_for_range(what, *number.value, range.lower, range.upper)));
    return std::nullopt;
  }
  return number.value;
}

}  // namespace softgrip::document
