#pragma once
// Declares the keys of a map, each key once. The declaration is used for the strict reader of the map, for
// the list of known keys in hints, and for the table of a reference page.

#include <chrono>
#include <cmath>
#include <concepts>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/enum_table.h"
#include "base/numbers.h"
#include "base/text.h"
#include "base/time.h"
#include "document/reader.h"

namespace softgrip::document {

/// The permitted values of a key: numbers from `lower` to `upper` (both included), one of several words, or
/// any value of the type.
struct Allowed {
  Allowed() = default;
  Allowed(double lower, double upper) : range{lower, upper} {}
  Allowed(Range numbers) : range(numbers) {}
  Allowed(std::vector<std::string> choices) : words(std::move(choices)) {}
  Allowed(std::initializer_list<const char*> choices) : words(choices.begin(), choices.end()) {}

  Range range{};
  std::vector<std::string> words;
};

/// The permitted values of a key with the type `Enum`: the names of all values, or of all values up to
/// `last`.
template <class Enum>
struct AllowedNames : Allowed {
  template <std::size_t count>
  AllowedNames(const EnumTable<Enum, std::string_view, count>& names,
               Enum last = static_cast<Enum>(count - 1))
      : Allowed(names.names()) {
    words.resize(static_cast<std::size_t>(last) + 1);
  }
};
template <class T>
struct AllowedOf {
  using type = std::conditional_t<std::is_enum_v<T>, AllowedNames<T>, Allowed>;
};
template <class T>
struct AllowedOf<std::optional<T>> : AllowedOf<T> {};

/// Description of a key, for its reader and for a reference page.
struct KeyFacts {
  std::string name;
  std::string values;    ///< permitted values, for example "0.001 to 100"
  std::string fallback;  ///< value that is used if the key is omitted, for example "0.1"; empty: the key is
                         ///< required
  std::string meaning;
  Allowed allowed{};

  [[nodiscard]] bool required() const noexcept { return fallback.empty(); }
};

/// One key of a map whose values are stored in a struct of type `S`.
template <class S>
struct Key {
  KeyFacts facts;
  /// Reads a required key, or an optional key that the map contains.
  std::function<void(MapReader& reader, const KeyFacts& facts, S& settings)> read;

  Key(KeyFacts described, decltype(read) reading) : facts(std::move(described)), read(std::move(reading)) {}
  /// Declares a key whose value the caller reads. read_keys() marks such a key as known, but does not read
  /// its value.
  Key(std::string name, std::string values, std::string fallback, std::string meaning)
      : facts{std::move(name), std::move(values), std::move(fallback), std::move(meaning), {}},
        read([](MapReader& reader, const KeyFacts& key, S&) {
          (void)reader.child(key.name, key.required());
        }) {}
  /// Creates a key from a key of a base class of the settings `S`.
  template <class Base>
  requires(std::derived_from<S, Base> && !std::same_as<S, Base>) Key(Key<Base> base)
      : facts(std::move(base.facts)), read(std::move(base.read)) {}
};
template <class S>
using Keys = std::vector<Key<S>>;

/// Reads all keys of a map in the order of the declaration. If an optional key is omitted, its member in
/// `settings` keeps its value.
template <class S>
void read_keys(MapReader& reader, const Keys<S>& keys, S& settings) {
  for (const Key<S>& key : keys)
    if (key.facts.required() || reader.child(key.facts.name, false) != nullptr)
      key.read(reader, key.facts, settings);
}

/// Reads the map under `name` of the map `outer` into `settings`, then calls `check` for keys and conditions
/// that have no declaration. `what` is the name of the map in messages; the default is `name`. Does nothing
/// if an optional map is absent.
template <class S>
void read_map(MapReader& outer, const std::string& name, bool required, const Keys<S>& keys, S& settings,
              const std::function<void(MapReader& reader)>& check = nullptr, const std::string& what = "") {
  const Node* const node = outer.child(name, required);
  if (node == nullptr) return;
  MapReader reader = outer.inner(*node, what.empty() ? name : what);
  read_keys(reader, keys, settings);
  if (check) check(reader);
}

/// The tables of a reference page, with their names.
using KeyTables = std::vector<std::pair<std::string, std::vector<KeyFacts>>>;

/// Appends the descriptions of the keys for a reference page. The text `map` is put before the name of each
/// key: "listen: port".
template <class S>
void append_facts(std::vector<KeyFacts>& facts, const Keys<S>& keys, const std::string& map = "") {
  for (const Key<S>& key : keys) {
    facts.push_back(key.facts);
    facts.back().name.insert(0, map);
  }
}

/// Returns the descriptions of the keys of several lists, for one table of a reference page.
template <class... S>
std::vector<KeyFacts> facts_of(const Keys<S>&... lists) {
  std::vector<KeyFacts> facts;
  (append_facts(facts, lists), ...);
  return facts;
}

/// Reads the value of a key. The key is required, or the caller has checked that it is present.
template <class T>
void read_value(MapReader& reader, std::string_view key, const Allowed& allowed, T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    value = allowed.words.empty() ? reader.boolean(key) : reader.choice(key, allowed.words) == 1;
  } else if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(reader.choice(key, allowed.words));  // the words are AllowedNames
  } else if constexpr (std::is_integral_v<T>) {
    value = static_cast<T>(reader.integer(key, allowed.range));
  } else if constexpr (std::is_floating_point_v<T>) {
    value = reader.number(key, allowed.range);
  } else if constexpr (std::is_same_v<T, std::chrono::nanoseconds>) {
    value = T(nanoseconds(reader.number(key, allowed.range)));
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = allowed.words.empty() ? reader.text(key) : allowed.words[reader.choice(key, allowed.words)];
  } else {
    read_value(reader, key, allowed, value.emplace());
  }
}

/// Returns the permitted values as text: "0.001 to 100", "`none` or `look`", "at least 0" ...
[[nodiscard]] inline std::string text_of(const Allowed& allowed) {
  return allowed.words.empty() ? text_of(allowed.range) : enumerated(allowed.words, " or ", in_backticks);
}

/// Returns the default of an optional key as text. Returns "none" if the default has no text.
template <class T>
std::string default_text(const T& value, const Allowed& allowed) {
  if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
    const auto index = static_cast<std::size_t>(value);
    return in_backticks(allowed.words.empty() ? (value == T{} ? "false" : "true") : allowed.words.at(index));
  } else if constexpr (std::is_arithmetic_v<T>) {
    return std::isfinite(static_cast<double>(value)) ? written(static_cast<double>(value)) : "none";
  } else if constexpr (std::is_same_v<T, std::string>) {
    return value.empty() ? "none" : in_backticks(value);
  } else {
    return "none";
  }
}

/// Declares a required key. `member` is the member in which the value is stored.
template <class S, class T>
Key<S> required(std::string name, T S::*member, const typename AllowedOf<T>::type& allowed,
                std::string meaning) {
  std::string values = text_of(allowed);
  if (std::is_same_v<T, bool> && allowed.words.empty()) values = "`true` or `false`";
  if (std::is_same_v<T, std::string> && allowed.words.empty()) values = "a text";
  return {{std::move(name), std::move(values), "", std::move(meaning), Allowed(allowed)},
          [member](MapReader& reader, const KeyFacts& key, S& settings) {
            read_value(reader, key.name, key.allowed, settings.*member);
          }};
}

/// Declares an optional key. Its default is the value of the member in `S{}`. `fallback` describes a default
/// that has no text, or that the caller computes.
template <class S, class T>
Key<S> optional(std::string name, T S::*member, const typename AllowedOf<T>::type& allowed,
                std::string meaning, std::string fallback = "") {
  static const S defaults{};
  Key<S> key = required(std::move(name), member, allowed, std::move(meaning));
  key.facts.fallback =
      fallback.empty() ? default_text(defaults.*member, key.facts.allowed) : std::move(fallback);
  return key;
}

/// Creates a key of `S` from a key of its member `part`.
template <class S, class Part>
Key<S> within(Part S::*part, Key<Part> key) {
  return {std::move(key.facts),
          [part, read = std::move(key.read)](MapReader& reader, const KeyFacts& facts, S& settings) {
            read(reader, facts, settings.*part);
          }};
}

}  // namespace softgrip::document
