#include "tools/web/access/tokens.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "base/files.h"

namespace softgrip::web {

namespace {

constexpr std::size_t longest_file = 65536;
constexpr const char* how_to_make = "to create a token, run `openssl rand -hex 24`";

/// Removes the first word from the line and returns this word.
std::string_view word_of(std::string_view& line) {
  const auto blank = [](char character) {
    return character == ' ' || character == '\t' || character == '\r';
  };
  while (!line.empty() && blank(line.front())) line.remove_prefix(1);
  const auto end = std::find_if(line.begin(), line.end(), blank);
  const std::string_view word(line.data(), static_cast<std::size_t>(end - line.begin()));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace

bool is_name_character(char character) noexcept {
  const auto within = [character](char first, char last) { return character >= first && character <= last; };
  return within('a', 'z') || within('A', 'Z') || within('0', '9') || character == '-' || character == '_';
}

bool equal_in_constant_time(std::string_view one, std::string_view other) noexcept {
  // The duration of the comparison may show that the lengths are different, but it must not depend on the
  // content of the texts.
  if (one.size() != other.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < one.size(); ++i)
    difference |=
        static_cast<unsigned>(static_cast<unsigned char>(one[i]) ^ static_cast<unsigned char>(other[i]));
  return difference == 0;
}

tl::expected<Tokens, std::string> Tokens::parse(std::string_view text) {
  Tokens tokens;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view role = word_of(line);
    if (role.empty() || role.front() == '#') continue;
    const std::string_view token = word_of(line);
    if (role != "look" && role != "operate")
      return tl::unexpected{fmt::format("line {}: the first word must be `look` or `operate`", number)};
    if (!word_of(line).empty())
      return tl::unexpected{fmt::format("line {}: unexpected text after the role and the token", number)};
    if (token.size() < shortest || token.size() > longest ||
        !std::all_of(token.begin(), token.end(), is_name_character)) {
      return tl::unexpected{fmt::format("line {}: a token has {} to {} letters, digits, - and _; {}", number,
                                        shortest, longest, how_to_make)};
    }
    if (tokens.role_of(token) != Role::none)
      return tl::unexpected{fmt::format("line {}: an earlier line contains the same token", number)};
    tokens.tokens_.push_back({role == "look" ? Role::look : Role::operate, std::string(token)});
  }
  if (tokens.empty()) return tl::unexpected{fmt::format("the token file contains no token; {}", how_to_make)};
  return tokens;
}

tl::expected<Tokens, std::string> Tokens::load(const std::string& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0)
    return tl::unexpected{fmt::format("cannot read {}: {}", path, std::strerror(errno))};
  if ((about.st_mode & 07U) != 0)
    return tl::unexpected{fmt::format("all users can read {}: run `chmod o= {}`", path, path)};
  const auto text = read_file(path, longest_file);
  if (!text) return tl::unexpected{text.error()};
  auto tokens = parse(*text);
  if (!tokens) return tl::unexpected{fmt::format("{}, {}", path, tokens.error())};
  return tokens;
}

Grant Tokens::grant_of(std::string_view token) const noexcept {
  Grant grant;
  // The search continues after a match, because its duration must not depend on the token.
  for (std::size_t number = 0; number < tokens_.size(); ++number) {
    if (equal_in_constant_time(tokens_[number].text, token)) grant = {tokens_[number].role, number};
  }
  return grant;
}

}  // namespace softgrip::web
