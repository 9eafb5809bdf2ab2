#pragma once
// The files of the page. They are compiled into the program, so that a path in a browser's request never
// selects a file on the disk.

#include <string_view>

namespace softgrip::web {

[[nodiscard]] std::string_view page_html() noexcept;
[[nodiscard]] std::string_view page_css() noexcept;
[[nodiscard]] std::string_view page_js() noexcept;

}  // namespace softgrip::web
