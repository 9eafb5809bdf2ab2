#include "tools/web/access/gate.h"

#include <algorithm>
#include <utility>

#include "base/net/listener.h"

namespace softgrip::web {
namespace {

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char digit) { return digit >= '0' && digit <= '9'; });
}

bool equal_ignoring_case(std::string_view one, std::string_view other) {
  const auto lower = [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  };
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [&](char a, char b) { return lower(a) == lower(b); });
}

}  // namespace

Gate::Gate(const Settings& settings, Tokens tokens)
    : settings_(settings),
      tokens_(std::move(tokens)),
      sessions_(nanoseconds(settings.session_idle_s), nanoseconds(settings.session_s)) {}

tl::expected<Role, Refusal> Gate::authorize(const Credentials& credentials, bool changes, Nanoseconds now) {
  if (!is_own_host(credentials.host, settings_.hosts)) {
    return tl::unexpected{Refusal{421,
                                  "the Host header contains an unknown name; if this name is correct, add it "
                                  "to `hosts` under `listen` in the configuration file"}};
  }
  const bool is_other_origin =
      !credentials.origin.empty() && !is_own_origin(credentials.origin, credentials.host);
  const bool is_cross_site = credentials.fetch_site == "cross-site" || credentials.fetch_site == "same-site";
  if (is_other_origin || (changes && is_cross_site))
    return tl::unexpected{Refusal{403, "the request was sent by a web page of a different server"}};
  const bool has_origin_or_token =
      !credentials.origin.empty() || !bearer_of(credentials.authorization).empty();
  if (changes && !has_origin_or_token)
    return tl::unexpected{Refusal{403, "the request has no Origin header and no token"}};
  return role_of(credentials, now);
}

Role Gate::role_of(const Credentials& credentials, Nanoseconds now) {
  Role role = settings_.without_token;
  if (const std::string_view token = bearer_of(credentials.authorization); !token.empty())
    role = std::max(role, tokens_.role_of(token));
  if (const std::string_view id = cookie_of(credentials.cookie, session_cookie); !id.empty())
    role = std::max(role, sessions_.role_of(id, now));
  return role;
}

tl::expected<std::string, Refusal> Gate::open(std::string_view token, Nanoseconds now) {
  const Grant grant = tokens_.grant_of(token);
  if (grant.role == Role::none)
    return tl::unexpected{Refusal{401, "unknown token: the token file does not contain this token"}};
  return sessions_.open(grant, now);
}

void Gate::close(std::string_view cookie_header) {
  sessions_.close(cookie_of(cookie_header, session_cookie));
}

bool is_own_host(std::string_view host, const std::vector<std::string>& names) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return false;
    const std::string_view rest = host.substr(end + 1);
    const bool port_or_none = rest.empty() || (rest.front() == ':' && is_port(rest.substr(1)));
    return port_or_none && net::is_numeric(std::string(host.substr(1, end - 1)));
  }
  if (const std::size_t colon = host.find(':'); colon != std::string_view::npos) {
    if (!is_port(host.substr(colon + 1))) return false;
    host = host.substr(0, colon);
  }
  if (equal_ignoring_case(host, "localhost") || net::is_numeric(std::string(host))) return true;
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return equal_ignoring_case(host, name); });
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return equal_ignoring_case(origin.substr(scheme.size()), host);
  }
  return false;
}

std::string_view cookie_of(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(';'), header.size());
    std::string_view pair = header.substr(0, end);
    header.remove_prefix(std::min(end + 1, header.size()));
    while (pair.starts_with(' ')) pair.remove_prefix(1);
    if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
      return pair.substr(name.size() + 1);
  }
  return {};
}

std::string_view bearer_of(std::string_view header) {
  constexpr std::string_view kind = "Bearer ";
  return header.starts_with(kind) ? header.substr(kind.size()) : std::string_view();
}

}  // namespace softgrip::web
