#pragma once
// Checks that a request comes from the page of this server, and not from a page of another site in the same
// browser.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::web {

/// Returns true if a Host header names this computer: a numeric address, `localhost` or one of `names`, each
/// with or without a port. All other names are refused, because an attacker could own such a name and assign
/// it to the address of this computer. The browser would then treat the attacker's page and this server's
/// page as one origin (DNS rebinding).
[[nodiscard]] bool is_own_host(std::string_view host, const std::vector<std::string>& names);

/// Returns true if the page with this Origin header was loaded from the server with this Host header.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host);

/// Returns the value of a cookie in a Cookie header; "" if the header has no cookie with this name.
[[nodiscard]] std::string_view cookie_of(std::string_view header, std::string_view name);

/// Returns the token of an Authorization header of type Bearer; "" for any other header.
[[nodiscard]] std::string_view bearer_of(std::string_view header);

}  // namespace softgrip::web
