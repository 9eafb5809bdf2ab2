#pragma once
// Reads secret tokens. Each token gives a browser or a metrics collector a role.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "rig/web_file/settings.h"

namespace softgrip::web {

/// Returns true if two texts are equal. For texts of equal length, the duration of the comparison does not
/// depend on the content.
[[nodiscard]] bool equal_in_constant_time(std::string_view one, std::string_view other) noexcept;

/// Returns true for the characters of tokens, of names of headers and of file names: letters and digits of
/// ASCII, "-" and "_".
[[nodiscard]] bool is_name_character(char character) noexcept;

/// The role of a token, and the position of the token in the token file.
struct Grant {
  Role role = Role::none;  ///< role that the token gives; none: the token is not in the file
  std::size_t token = 0;   ///< index of the token in the file, from 0
};

class Tokens {
 public:
  static constexpr std::size_t shortest = 20;
  static constexpr std::size_t longest = 128;

  /// Parses lines of the form `look TOKEN` or `operate TOKEN`. Skips empty lines and lines that begin with #.
  /// The error is a sentence that names the line and never contains the token.
  [[nodiscard]] static tl::expected<Tokens, std::string> parse(std::string_view text);
  /// Reads a token file. Refuses a file that users other than its owner and its group may read. The error is
  /// a sentence.
  [[nodiscard]] static tl::expected<Tokens, std::string> load(const std::string& path);

  /// Returns the role of a token and the index of the token in the file.
  [[nodiscard]] Grant grant_of(std::string_view token) const noexcept;
  /// Returns the role of a token; none if the token is not in the file.
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
