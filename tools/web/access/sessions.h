#pragma once
// Stores the sessions of browsers that have sent a valid token.

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "base/time.h"
#include "rig/web_file/settings.h"
#include "tools/web/access/tokens.h"

namespace softgrip::web {

/// Keeps sessions in memory, not on the disk. A session ends in four cases: it is idle for too long, it is
/// too old, its browser closes it, or `most_per_token` newer sessions were opened with the same token. A
/// client with a different token cannot end the session.
class Sessions {
 public:
  /// Largest number of sessions per token. It is larger than 1, because the browsers of one team share a
  /// token. The number of tokens is limited by the size of the token file.
  static constexpr std::size_t most_per_token = 32;

  Sessions(Nanoseconds longest_idle, Nanoseconds longest) : longest_idle_(longest_idle), longest_(longest) {}

  /// Opens a session and returns its id: 256 random bits as text. If the token has too many sessions, the
  /// session that has been idle for the longest time ends.
  [[nodiscard]] std::string open(Grant grant, Nanoseconds now);
  /// Returns the role of the session; none if the session does not exist. The call restarts the idle time of
  /// the session.
  [[nodiscard]] Role role_of(std::string_view id, Nanoseconds now);
  void close(std::string_view id);
  [[nodiscard]] std::size_t size() const noexcept { return sessions_.size(); }

 private:
  struct Session {
    Grant grant;
    Nanoseconds opened_at = 0;
    Nanoseconds last_used = 0;
  };
  [[nodiscard]] bool ended(const Session& session, Nanoseconds now) const noexcept {
    return now - session.last_used > longest_idle_ || now - session.opened_at > longest_;
  }

  void end_most_idle(std::size_t token);

  Nanoseconds longest_idle_;
  Nanoseconds longest_;
  std::map<std::string, Session, std::less<>> sessions_;
};

}  // namespace softgrip::web
