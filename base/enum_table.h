#pragma once
// Declares the names of an enum, and other data of its values, as a table with one row per enumerator. A
// table that lacks an enumerator or that lists the enumerators in another order does not compile.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace softgrip {

/// Returns true if an enum has an enumerator with this value. In the name of this function, the compiler
/// writes an enumerator as "State::idle", and any other value as a number with a cast: "(State)6".
template <auto value>
requires std::is_enum_v<decltype(value)>
[[nodiscard]] consteval bool is_enumerator() noexcept {
  constexpr std::string_view function = __PRETTY_FUNCTION__;
  const char first = function[function.find_last_of(":)") + 1];
  return (first < '0' || first > '9') && first != '-';
}

/// The data `Info` of one value of an enum.
template <class Enum, class Info>
struct EnumRow {
  Enum value;
  Info info;
};

/// The data `Info` of all values of an enum. The enumerators have the values 0, 1, ... `count` - 1.
template <class Enum, class Info, std::size_t count>
class EnumTable {
 public:
  /// Stops the compilation unless the rows contain each enumerator once, in the order of the enumerators.
  consteval EnumTable(const EnumRow<Enum, Info> (&rows)[count]) : rows_(std::to_array(rows)) {
    static_assert(!is_enumerator<static_cast<Enum>(count)>(), "an enumerator has no row");
    for (std::size_t i = 0; i < count; ++i) {
      if (static_cast<std::size_t>(rows[i].value) != i)
        throw "the rows are not in the order of the enumerators";
    }
  }

  /// Returns the data of a value. For a number that is no enumerator, returns the data of the first value.
  [[nodiscard]] constexpr const Info& operator[](Enum value) const noexcept {
    const auto index = static_cast<std::size_t>(value);
    return rows_[index < count ? index : 0].info;
  }
  [[nodiscard]] static constexpr std::size_t size() noexcept { return count; }
  [[nodiscard]] constexpr auto begin() const noexcept { return rows_.begin(); }
  [[nodiscard]] constexpr auto end() const noexcept { return rows_.end(); }

  /// Returns the value with this name; nullopt if no value has this name.
  [[nodiscard]] constexpr std::optional<Enum> find(
      std::string_view name) const noexcept requires std::same_as<Info, std::string_view> {
    const auto found = std::find_if(begin(), end(), [&](const auto& row) { return row.info == name; });
    return found == end() ? std::nullopt : std::optional(found->value);
  }
  /// Returns all names in the order of the values.
  [[nodiscard]] std::vector<std::string> names() const requires std::same_as<Info, std::string_view> {
    std::vector<std::string> all;
    for (const auto& row : rows_) all.emplace_back(row.info);
    return all;
  }

 private:
  std::array<EnumRow<Enum, Info>, count> rows_;
};

/// Returns the table of the rows {value, data}.
template <class Enum, class Info, std::size_t count>
[[nodiscard]] consteval auto enum_table(const EnumRow<Enum, Info> (&rows)[count]) {
  return EnumTable<Enum, Info, count>(rows);
}

/// Returns the table of the rows {value, name}.
template <class Enum, std::size_t count>
[[nodiscard]] consteval auto enum_names(const EnumRow<Enum, std::string_view> (&rows)[count]) {
  return EnumTable<Enum, std::string_view, count>(rows);
}

}  // namespace softgrip
