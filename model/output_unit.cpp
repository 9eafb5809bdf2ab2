#include "model/output_unit.h"

#include <cstddef>

namespace softgrip::model {
namespace {

bool is_part_of_a_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

void replace_word(std::string& text, std::string_view word, std::string_view by) {
  std::size_t at = text.find(word);
  while (at != std::string::npos) {
    const std::size_t end = at + word.size();
    const bool whole = (at == 0 || !is_part_of_a_word(text[at - 1])) &&
                       (end == text.size() || !is_part_of_a_word(text[end]));
    if (whole) text.replace(at, word.size(), by);
    at = text.find(word, whole ? at + by.size() : end);
  }
}

}  // namespace

std::string_view name_of(OutputUnit unit) noexcept {
  return unit == OutputUnit::deg ? "deg" : "mm";
}

std::string in_unit(std::string_view text, OutputUnit unit) {
  std::string result(text);
  if (unit == OutputUnit::mm) return result;
  replace_word(result, "mm", name_of(unit));
  replace_word(result, "displacement", "bending angle");
  return result;
}

}  // namespace softgrip::model
