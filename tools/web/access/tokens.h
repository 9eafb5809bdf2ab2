#pragma once
// Secrets by which a browser or a collector shows what it may do.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "rig/web_file/settings.h"

namespace softgrip::web {

/// Whether two texts are equal, in a time that tells nothing of where they differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view one, std::string_view other) noexcept;

/// What a token allows, and which of the file's tokens it is.
struct Grant {
  Role role = Role::none;  ///< none: the file does not list the token
  std::size_t token = 0;   ///< its number in the file, from 0
};

class Tokens {
 public:
  static constexpr std::size_t shortest = 20;
  static constexpr std::size_t longest = 128;

  /// Lines `look TOKEN` and `operate TOKEN`; empty ones and those that begin with # are skipped. The error is
  /// a sentence that names the line and never the token.
  [[nodiscard]] static tl::expected<Tokens, std::string> parse(std::string_view text);
  /// Of a file that only its owner and group may read; the error is a sentence.
  [[nodiscard]] static tl::expected<Tokens, std::string> load(const std::string& path);

  /// Returns what the bearer of a token may do.
  [[nodiscard]] Grant grant_of(std::string_view token) const noexcept;
  /// The role of grant_of().
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
