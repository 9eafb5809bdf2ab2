#include "tools/web/access/sessions.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace softgrip::web {

namespace {

std::string random_id() {
  std::array<unsigned char, 32> bytes{};
  // For a request of up to 256 bytes, getrandom() either returns all bytes or fails.
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::system_error(errno, std::generic_category(), "getrandom");
  constexpr std::string_view digits = "0123456789abcdef";
  std::string id;
  for (const unsigned char byte : bytes) {
    id += digits[byte >> 4U];
    id += digits[byte & 15U];
  }
  return id;
}

}  // namespace

std::string Sessions::open(Grant grant, Nanoseconds now) {
  std::erase_if(sessions_, [&](const auto& entry) { return ended(entry.second, now); });
  const auto of_token = std::count_if(sessions_.begin(), sessions_.end(), [&](const auto& entry) {
    return entry.second.grant.token == grant.token;
  });
  if (static_cast<std::size_t>(of_token) >= most_per_token) end_most_idle(grant.token);
  std::string id = random_id();
  sessions_[id] = {grant, now, now};
  return id;
}

void Sessions::end_most_idle(std::size_t token) {
  auto most_idle = sessions_.end();
  for (auto entry = sessions_.begin(); entry != sessions_.end(); ++entry) {
    if (entry->second.grant.token != token) continue;
    if (most_idle == sessions_.end() || entry->second.last_used < most_idle->second.last_used)
      most_idle = entry;
  }
  if (most_idle != sessions_.end()) sessions_.erase(most_idle);
}

Role Sessions::role_of(std::string_view id, Nanoseconds now) {
  const auto found = sessions_.find(id);
  if (found == sessions_.end()) return Role::none;
  if (ended(found->second, now)) {
    sessions_.erase(found);
    return Role::none;
  }
  found->second.last_used = now;
  return found->second.grant.role;
}

void Sessions::close(std::string_view id) {
  if (const auto found = sessions_.find(id); found != sessions_.end()) sessions_.erase(found);
}

}  // namespace softgrip::web
