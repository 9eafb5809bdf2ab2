#pragma once
// Who may do what.

#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "base/time.h"
#include "rig/web_file/settings.h"
#include "tools/web/access/sessions.h"
#include "tools/web/access/tokens.h"

namespace softgrip::web {

inline constexpr std::string_view session_cookie = "softgrip";

/// What of a request decides over it.
struct Credentials {
  std::string host;
  std::string origin;      ///< empty where the client sent none
  std::string fetch_site;  ///< what a browser says of where the request comes from; may be empty
  std::string cookie;      ///< the header
  std::string authorization;
};

/// Why a request is turned away: a status of HTTP and a sentence.
struct Refusal {
  int status = 403;
  std::string message;
};

class Gate {
 public:
  /// `settings` outlives it.
  Gate(const Settings& settings, Tokens tokens);

  /// Whether the request comes from the page itself, and what its sender may do. Whatever `changes` anything
  /// must come from the page, or bring a token in its header, which no other page can make a browser do.
  [[nodiscard]] tl::expected<Role, Refusal> admit(const Credentials& credentials, bool changes,
                                                  Nanoseconds now);
  /// A session for a token; a refusal for one that nobody gave out.
  [[nodiscard]] tl::expected<std::string, Refusal> open(std::string_view token, Nanoseconds now);
  void close(std::string_view cookie_header);
  [[nodiscard]] bool has_tokens() const noexcept { return !tokens_.empty(); }

 private:
  [[nodiscard]] Role role_of(const Credentials& credentials, Nanoseconds now);

  const Settings& settings_;
  Tokens tokens_;
  Sessions sessions_;
};

}  // namespace softgrip::web
