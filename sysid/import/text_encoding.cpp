#include "sysid/import/text_dialect.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "sysid/import/table.h"

namespace softgrip::sysid {
namespace {

void append(std::string& text, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { text.push_back(static_cast<char>(byte)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xc0 | (code >> 6));
    put(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    put(0xe0 | (code >> 12));
    put(0x80 | ((code >> 6) & 0x3f));
    put(0x80 | (code & 0x3f));
  } else {
    put(0xf0 | (code >> 18));
    put(0x80 | ((code >> 12) & 0x3f));
    put(0x80 | ((code >> 6) & 0x3f));
    put(0x80 | (code & 0x3f));
  }
}

std::string from_utf16(std::string_view bytes, bool big_endian) {
  std::string text;
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<std::uint8_t>(bytes[i]);
    const auto second = static_cast<std::uint8_t>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xd800 && code < 0xdc00 && i + 3 < bytes.size()) {
      code = 0x10000 + ((code - 0xd800) << 10) + ((unit(i + 2) - 0xdc00) & 0x3ff);
      i += 2;
    }
    append(text, code);
  }
  return text;
}

/// Returns the number of continuation bytes that follow the first byte of a UTF-8 character. Returns -1 if
/// `first` cannot be a first byte.
int continuations(std::uint8_t first) {
  if (first < 0x80) return 0;
  if (first >= 0xc2 && first < 0xe0) return 1;
  if (first >= 0xe0 && first < 0xf0) return 2;
  return first >= 0xf0 && first < 0xf5 ? 3 : -1;
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    int left = continuations(static_cast<std::uint8_t>(text[i++]));
    if (left < 0) return false;
    for (; left > 0; --left, ++i) {
      if (i == text.size() || (static_cast<std::uint8_t>(text[i]) & 0xc0U) != 0x80) return false;
    }
  }
  return true;
}

/// Replaces each "\r" by "\n" if the text contains no "\n", because old Macintosh files end their lines with
/// "\r" alone.
void normalise_line_ends(std::string& text) {
  if (text.find('\n') != std::string::npos) return;
  for (char& c : text) c = c == '\r' ? '\n' : c;
}

/// Byte order of a text in UTF-16.
enum class ByteOrder : std::uint8_t { little_endian, big_endian };

/// Returns the byte order of a text in UTF-16; nullopt for another text. Without a byte order mark, the bytes
/// are UTF-16 if the high bytes of most of the first 32 characters are 0 and no low byte is 0.
std::optional<ByteOrder> utf16_order(std::string_view bytes) {
  if (bytes.starts_with("\xff\xfe")) return ByteOrder::little_endian;
  if (bytes.starts_with("\xfe\xff")) return ByteOrder::big_endian;
  constexpr std::size_t beginning = 64;
  if (bytes.size() < beginning) return std::nullopt;
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < beginning; ++i) zeros.at(i % 2) += bytes[i] == '\0' ? 1U : 0U;
  if (4 * (zeros[0] + zeros[1]) < 3 * (beginning / 2) || zeros[0] * zeros[1] != 0) return std::nullopt;
  return zeros[1] > 0 ? ByteOrder::little_endian : ByteOrder::big_endian;
}

/// Returns the number of NUL bytes at the end of a text. Returns 0 for UTF-16, whose characters contain NUL
/// bytes.
std::size_t nul_tail(std::string_view bytes) {
  if (utf16_order(bytes)) return 0;
  const std::size_t last = bytes.find_last_not_of('\0');
  return last == std::string_view::npos ? 0 : bytes.size() - last - 1;
}

/// Returns the number of the first line that is longer than longest_line, counted from 1; nullopt if there is
/// no such line.
std::optional<std::size_t> number_of_long_line(std::string_view text) {
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > longest_line) return number;
    begin = end + 1;
  }
  return std::nullopt;
}

}  // namespace

tl::expected<std::string, std::string> utf8_of(std::string_view bytes) {
  std::string text;
  if (const auto order = utf16_order(bytes)) {
    const bool has_mark = bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
    text = from_utf16(bytes.substr(has_mark ? 2 : 0), *order == ByteOrder::big_endian);
  } else if (bytes.find('\0') != std::string_view::npos) {
    return tl::unexpected(std::string("this file is not a text file, and its format is not known"));
  } else if (is_utf8(bytes)) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    text = bytes;
  } else {
    for (const char c : bytes) append(text, static_cast<std::uint8_t>(c));
  }
  normalise_line_ends(text);
  return text;
}

std::optional<ForeignText> foreign_text(const std::string& file, std::string_view bytes,
                                        document::Problems& problems) {
  const auto refused = [&](const std::string& message, const char* hint) {
    problems.add({file, {1, 1}, {}, message, hint});
    return std::nullopt;
  };
  const auto too_long = [&](std::size_t most, const char* what) {
    return refused("the text has more than " + std::to_string(most) + what,
                   "split the file into several files");
  };
  if (bytes.size() > most_text_bytes) return too_long(most_text_bytes, " bytes");
  const std::size_t nul_bytes = nul_tail(bytes);
  auto text = utf8_of(bytes.substr(0, bytes.size() - nul_bytes));
  if (!text) return refused(text.error(), "export the data as CSV");
  if (static_cast<std::size_t>(std::count(text->begin(), text->end(), '\n')) > most_rows)
    return too_long(most_rows, " lines");
  if (const auto line = number_of_long_line(*text))
    return refused(
        "line " + std::to_string(*line) + " has more than " + std::to_string(longest_line) + " bytes",
        "export the data as CSV");
  ForeignText foreign{std::move(*text), {}};
  if (nul_bytes > 0)
    foreign.notes.push_back(std::to_string(nul_bytes) + " NUL bytes at the end of the file are left out");
  return foreign;
}

}  // namespace softgrip::sysid
