#pragma once
// Browsers that have shown a token.

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "base/time.h"
#include "rig/web_file/settings.h"

namespace softgrip::web {

/// A session ends when it was idle for long, when it is old, when its browser says so, and when too many
/// others come after it. Nothing of it outlives the process.
class Sessions {
 public:
  static constexpr std::size_t most = 64;

  Sessions(Nanoseconds longest_idle, Nanoseconds longest) : longest_idle_(longest_idle), longest_(longest) {}

  /// Its id: 256 random bits as text. The one that was idle for the longest time goes if there are too many.
  [[nodiscard]] std::string open(Role role, Nanoseconds now);
  /// What it may do, none if there is no such session (any more). Counts as a sign of life.
  [[nodiscard]] Role role_of(std::string_view id, Nanoseconds now);
  void close(std::string_view id);
  [[nodiscard]] std::size_t size() const noexcept { return sessions_.size(); }

 private:
  struct Session {
    Role role = Role::none;
    Nanoseconds opened = 0;
    Nanoseconds seen = 0;
  };
  [[nodiscard]] bool ended(const Session& session, Nanoseconds now) const noexcept {
    return now - session.seen > longest_idle_ || now - session.opened > longest_;
  }

  Nanoseconds longest_idle_;
  Nanoseconds longest_;
  std::map<std::string, Session, std::less<>> sessions_;
};

}  // namespace softgrip::web
