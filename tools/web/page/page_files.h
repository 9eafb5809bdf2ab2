#pragma once
// The page itself, which is part of the program: no file of a disk is named by a browser's path.

#include <string_view>

namespace softgrip::web {

[[nodiscard]] std::string_view page_html() noexcept;
[[nodiscard]] std::string_view page_css() noexcept;
[[nodiscard]] std::string_view page_js() noexcept;

}  // namespace softgrip::web
