#pragma once
// Decides which requests are accepted, and determines the role of the sender of a request.
// Checks that a request comes from the page of this server, and not from a page of another site in the same
// browser.

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/time.h"
#include "rig/web_file/settings.h"
#include "tools/web/access/sessions.h"
#include "tools/web/access/tokens.h"

namespace softgrip::web {

inline constexpr std::string_view session_cookie = "softgrip";

/// The data of a request that decide whether it is accepted.
struct Credentials {
  std::string host;
  std::string origin;      ///< the Origin header; empty if the client sent none
  std::string fetch_site;  ///< the Sec-Fetch-Site header of the request; may be empty
  std::string cookie;      ///< the Cookie header of the request; may be empty
  std::string authorization;
};

/// The reason why a request is refused: an HTTP status and a sentence.
struct Refusal {
  int status = 403;
  std::string message;
};

class Gate {
 public:
  /// Creates a gate for the roles of `tokens`. `settings` must outlive the gate.
  Gate(const Settings& settings, Tokens tokens);

  /// Returns the role of the sender. Returns a refusal if the request comes from the page of another site. If
  /// `changes` is true, the request changes the state of the rig or of a session. Such a request must come
  /// from the page of this server, or have a token in its Authorization header: no other page can make a
  /// browser send this header.
  [[nodiscard]] tl::expected<Role, Refusal> authorize(const Credentials& credentials, bool changes,
                                                      Nanoseconds now);
  /// Opens a session for the sender of a token and returns the id of the session. If the token is not in the
  /// token file, returns a refusal.
  [[nodiscard]] tl::expected<std::string, Refusal> open(std::string_view token, Nanoseconds now);
  void close(std::string_view cookie_header);
  [[nodiscard]] bool has_tokens() const noexcept { return !tokens_.empty(); }

 private:
  [[nodiscard]] Role role_of(const Credentials& credentials, Nanoseconds now);

  const Settings& settings_;
  Tokens tokens_;
  Sessions sessions_;
};

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
