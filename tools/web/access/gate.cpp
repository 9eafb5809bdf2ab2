#include "tools/web/access/gate.h"

#include <algorithm>
#include <utility>

#include "base/periodic_schedule.h"
#include "tools/web/access/origin.h"

namespace softgrip::web {

Gate::Gate(const Settings& settings, Tokens tokens)
    : settings_(settings),
      tokens_(std::move(tokens)),
      sessions_(nanoseconds(settings.session_idle_s), nanoseconds(settings.session_s)) {}

tl::expected<Role, Refusal> Gate::admit(const Credentials& credentials, bool changes, Nanoseconds now) {
  if (!is_own_host(credentials.host, settings_.hosts)) {
    return tl::unexpected{Refusal{421,
                                  "the Host header does not name this computer; add its name to `hosts` "
                                  "under `listen` in the configuration file"}};
  }
  const bool elsewhere = !credentials.origin.empty() && !is_own_origin(credentials.origin, credentials.host);
  const bool linked = credentials.fetch_site == "cross-site" || credentials.fetch_site == "same-site";
  if (elsewhere || (changes && linked))
    return tl::unexpected{Refusal{403, "the request was sent by a page of another server"}};
  const bool says_where = !credentials.origin.empty() || !bearer_of(credentials.authorization).empty();
  if (changes && !says_where)
    return tl::unexpected{Refusal{403, "the request has neither an Origin header nor a token"}};
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

}  // namespace softgrip::web
