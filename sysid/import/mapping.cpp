#include "sysid/import/mapping.h"

#include <cmath>
#include <utility>

#include "base/numbers.h"
#include "base/text.h"

namespace softgrip::sysid {
namespace {

constexpr std::array<std::pair<std::string_view, char>, 5> separator_words{
    {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"space", ' '}, {"bar", '|'}}};

}  // namespace

bool Mapping::complete() const {
  const Mapping& here = *this;
  return (here[Role::time].given() || rate_hz) && here[Role::displacement].given() &&
         (here[Role::command].given() || here[Role::pressure].given());
}

std::string options_of(const Mapping& mapping) {
  std::string text;
  const auto say = [&](std::string_view option, std::string_view value) {
    text += (text.empty() ? "--" : " --") + std::string(option) + " " + shell_word(value);
  };
  for (const RoleSpec& spec : roles) {
    const ColumnMapping& column = mapping[spec.role];
    for (const std::string& name : column.columns) say(spec.word, name);
  }
  for (const RoleSpec& spec : roles) {
    const ColumnMapping& column = mapping[spec.role];
    const std::string word = std::string(spec.word) + "=";
    if (!column.unit.empty()) say("unit", word + column.unit);
    if (column.scale) say("scale", word + shortest(*column.scale));
    if (column.zero) say("zero", word + shortest(*column.zero));
    if (column.zero_first) say("zero", word + "first");
  }
  if (mapping.rate_hz) say("rate-hz", shortest(*mapping.rate_hz));
  if (mapping.separator != 0) say("separator", word_of_separator(mapping.separator));
  for (const std::string& word : mapping.missing) say("missing", word);
  if (!mapping.channel.empty()) say("channel", mapping.channel);
  if (!mapping.sheet.empty()) say("sheet", mapping.sheet);
  if (mapping.skip_bad_lines) text += text.empty() ? "--skip-bad-lines" : " --skip-bad-lines";
  if (mapping.from_s > 0) say("from-s", shortest(mapping.from_s));
  if (std::isfinite(mapping.to_s)) say("to-s", shortest(mapping.to_s));
  return text;
}

char separator_named(std::string_view word) {
  for (const auto& [name, character] : separator_words) {
    if (word == name || word == std::string_view(&character, 1)) return character;
  }
  return 0;
}

std::string_view word_of_separator(char separator) {
  for (const auto& [name, character] : separator_words) {
    if (separator == character) return name;
  }
  return {};
}

}  // namespace softgrip::sysid
