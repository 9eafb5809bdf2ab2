#include "tools/web/places.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace softgrip::web {

namespace {

/// Number of descriptors that the program itself needs: standard streams, listener, signals, two connections
/// to the daemon, the disk thread, and a reserve for descriptors that are open for a short time.
constexpr std::size_t own_descriptors = 24;
constexpr std::size_t fewest_places = 4;

/// Returns the connection with the lowest role among the connections for which `may_go` returns true. If
/// several connections have this role, returns the connection whose last progress is the oldest.
template <class MayGo>
Victim first_to_go(const std::vector<Guest>& guests, const MayGo& may_go) {
  const auto rank = [](const Guest& guest) { return std::tuple(guest.role, guest.moved_at); };
  Victim victim;
  for (std::size_t i = 0; i < guests.size(); ++i) {
    if (may_go(guests[i]) && (!victim || rank(guests[i]) < rank(guests[*victim]))) victim = i;
  }
  return victim;
}

}  // namespace

std::size_t places_for(std::size_t wanted, std::size_t descriptors) noexcept {
  const std::size_t left = descriptors > own_descriptors ? descriptors - own_descriptors : 0;
  return std::min(wanted, std::max(fewest_places, left / 2));
}

Victim gives_way_to_newcomer(const std::vector<Guest>& guests, Nanoseconds now) {
  return first_to_go(guests, [now](const Guest& guest) {
    return guest.stay == Guest::Stay::asking && now - guest.moved_at > long_pause;
  });
}

Victim gives_way_to_lingering(const std::vector<Guest>& guests, Role role, Nanoseconds now) {
  return first_to_go(guests, [&](const Guest& guest) {
    if (guest.stay != Guest::Stay::lingering) return false;
    const bool takes_nothing = guest.unsent > 0 && now - guest.moved_at > long_pause;
    return guest.role < role || (guest.role == role && takes_nothing);
  });
}

Victim gives_way_for_bytes(const std::vector<Guest>& guests, Role role) {
  return first_to_go(guests, [role](const Guest& guest) { return guest.unsent > 0 && guest.role <= role; });
}

std::size_t unsent_of(const std::vector<Guest>& guests) {
  return std::accumulate(guests.begin(), guests.end(), std::size_t{0},
                         [](std::size_t sum, const Guest& guest) { return sum + guest.unsent; });
}

}  // namespace softgrip::web
