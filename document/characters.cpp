#include "document/characters.h"

#include <cstdint>

namespace softgrip::document {

namespace {

constexpr std::uint8_t byte_of(char c) {
  return static_cast<std::uint8_t>(c);
}

struct Lead {
  std::size_t length;
  std::uint8_t second_lower;  // lower end of the allowed range of the second byte of a character; the range
                              // excludes overlong forms and surrogates
  std::uint8_t second_upper;
};

Lead lead_of(std::uint8_t first) noexcept {
  if (first < 0x80) return {1, 0, 0};
  if (first < 0xC2) return {0, 0, 0};
  if (first < 0xE0) return {2, 0x80, 0xBF};
  if (first == 0xE0) return {3, 0xA0, 0xBF};
  if (first == 0xED) return {3, 0x80, 0x9F};
  if (first < 0xF0) return {3, 0x80, 0xBF};
  if (first == 0xF0) return {4, 0x90, 0xBF};
  if (first < 0xF4) return {4, 0x80, 0xBF};
  if (first == 0xF4) return {4, 0x80, 0x8F};
  return {0, 0, 0};
}

}  // namespace

std::size_t character_length(std::string_view text) noexcept {
  const Lead lead = lead_of(byte_of(text[0]));
  if (lead.length < 2) return lead.length;
  if (text.size() < lead.length) return 0;
  const std::uint8_t second = byte_of(text[1]);
  if (second < lead.second_lower || second > lead.second_upper) return 0;
  for (std::size_t i = 2; i < lead.length; ++i) {
    if ((byte_of(text[i]) & 0xC0) != 0x80) return 0;
  }
  return lead.length;
}

bool is_control(std::string_view character) noexcept {
  const std::uint8_t first = byte_of(character[0]);
  if (first < 0x20 || first == 0x7F) return true;
  return character.size() == 2 && first == 0xC2 && byte_of(character[1]) < 0xA0;
}

std::size_t append_visible(std::string& out, std::string_view& text) {
  const std::size_t length = character_length(text);
  if (length != 0 && !is_control(text.substr(0, length))) {
    out.append(text.substr(0, length));
    text.remove_prefix(length);
    return 1;
  }
  const std::size_t taken = length == 0 ? 1 : length;
  const std::size_t before = out.size();
  for (const char c : text.substr(0, taken)) {
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (c == '\r') {
      out += "\\r";
    } else {
      constexpr char digits[] = "0123456789abcdef";
      out += "\\x";
      out += digits[byte_of(c) >> 4];
      out += digits[byte_of(c) & 15];
    }
  }
  text.remove_prefix(taken);
  return out.size() - before;
}

}  // namespace softgrip::document
