#pragma once
// Writes the parts of a result as HTML, and escapes text for HTML and SVG.

#include <string>
#include <string_view>

#include "base/result/table.h"

namespace softgrip::result {

/// Returns `text` with entities in place of & < > " ', and with a replacement character in place of each
/// control character. The result is safe as content and as a quoted attribute, for any `text`.
[[nodiscard]] std::string escaped(std::string_view text);

/// Returns an element that contains the text, which is escaped, and a line break.
/// @param name  tag of the element; this text is not escaped.
[[nodiscard]] std::string element(std::string_view name, std::string_view text);

/// Returns the terms as a <dl> element. All texts are escaped.
[[nodiscard]] std::string html_of(const Terms& terms);
/// Returns the table as a <table> element in a <div> element of the class "scroll". The cells of a
/// right-aligned column have the class "n". All texts are escaped.
[[nodiscard]] std::string html_of(const Table& table);

}  // namespace softgrip::result
