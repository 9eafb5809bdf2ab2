#pragma once
// Secret tokens that give a browser or a collector a role.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "rig/web_file/settings.h"

namespace softgrip::web {

/// Returns true if two texts are equal. The duration of the comparison does not depend on the position of the
/// first difference.
[[nodiscard]] bool equal_in_constant_time(std::string_view one, std::string_view other) noexcept;

/// The role of a token, and its position in the file.
struct Grant {
  Role role = Role::none;  ///< none: the file does not list the token
  std::size_t token = 0;   ///< its number in the file, from 0
};

class Tokens {
 public:
  static constexpr std::size_t shortest = 20;
  static constexpr std::size_t longest = 128;

  /// Parses lines `look TOKEN` and `operate TOKEN`. Empty lines and lines that begin with # are skipped. The
  /// error is a sentence that names the line and never contains the token.
  [[nodiscard]] static tl::expected<Tokens, std::string> parse(std::string_view text);
  /// Loads a file that only its owner and its group may read. The error is a sentence.
  [[nodiscard]] static tl::expected<Tokens, std::string> load(const std::string& path);

  /// Returns the role and the number of a token.
  [[nodiscard]] Grant grant_of(std::string_view token) const noexcept;
  /// Returns the role of a token.
  [[nodiscard]] Role role_of(std::string_view token) const noexcept { return grant_of(token).role; }
  [[nodiscard]] bool empty() const noexcept { return tokens_.empty(); }

 private:
  struct Token {
    Role role = Role::none;
    std::string text;
  };
  std::vector<Token> tokens_;
};

}  // namespace softgrip::web
