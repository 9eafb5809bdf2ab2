#pragma once
// Whether a request comes from the page itself, and not from another one that the browser shows.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::web {

/// Whether a Host header names this computer: a numeric address, `localhost`, or one of `names`, each with or
/// without a port. Another name is that of somebody who made it point here, so that the browser takes his
/// page and this one for the same.
[[nodiscard]] bool is_own_host(std::string_view host, const std::vector<std::string>& names);

/// Whether an Origin header is that of a page which was loaded from this Host.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host);

/// The value of a cookie in a Cookie header; empty if there is none of that name.
[[nodiscard]] std::string_view cookie_of(std::string_view header, std::string_view name);

/// The token of an Authorization header of the kind Bearer; empty if it is none.
[[nodiscard]] std::string_view bearer_of(std::string_view header);

}  // namespace softgrip::web
