#include "tools/plc/masters.h"

#include <algorithm>
#include <tuple>

#include "base/periodic_schedule.h"

namespace softgrip::plc {

namespace {

/// Largest age of the last request of a connection that counts as in use. A client normally sends several
/// requests per second.
constexpr Nanoseconds in_use = ns_per_s;

bool is_idle(const Master& master, Nanoseconds now) {
  return now - master.asked_at >= in_use;
}

}  // namespace

Command command_in(const Written& written) noexcept {
  const auto word = [&](Name name) { return written[static_cast<std::size_t>(name)]; };
  return {word(Name::command), word(Name::recipe), word(Name::squeeze), word(Name::speed),
          word(Name::displacement)};
}

std::optional<Masters::Id> Masters::admit(const std::string& address, Nanoseconds now) {
  if (masters_.size() >= most_) {
    const Place dropped = to_drop_for(address, now);
    if (dropped == masters_.end()) return std::nullopt;
    masters_.erase(dropped);
  }
  Master& master = masters_[++last_id_];
  master.address = address;
  master.asked_at = now;
  if (const auto past = past_.find(address); past != past_.end()) {
    master.cursor.at = past->second.at;
  }
  return last_id_;
}

std::size_t Masters::places_of(const std::string& address) const {
  return static_cast<std::size_t>(std::count_if(
      masters_.begin(), masters_.end(), [&](const auto& entry) { return entry.second.address == address; }));
}

Masters::Place Masters::to_drop_for(const std::string& address, Nanoseconds now) {
  const bool has_none = places_of(address) == 0;
  // The rank gives the order in which connections are removed. The connections of the address with the most
  // connections come first. Among the connections of one address, those without a request come first, and
  // after them the connection with the oldest request.
  const auto rank = [&](const Place place) {
    const Master& master = place->second;
    return std::tuple(masters_.size() - places_of(master.address), master.asked, master.asked_at);
  };
  Place found = masters_.end();
  for (Place place = masters_.begin(); place != masters_.end(); ++place) {
    const std::string& other = place->second.address;
    const bool may_go = has_none ? places_of(other) > 1 : other == address;
    if (may_go && (found == masters_.end() || rank(place) < rank(found))) found = place;
  }
  const bool goes = has_none || found == masters_.end() || is_idle(found->second, now);
  return goes ? found : masters_.end();
}

Master* Masters::find(Id id) noexcept {
  const auto found = masters_.find(id);
  return found == masters_.end() ? nullptr : &found->second;
}

void Masters::drop_halves(Id except) {
  std::erase_if(masters_, [except](const auto& entry) { return entry.first != except && entry.second.half; });
}

void Masters::fence() noexcept {
  for (auto& [id, master] : masters_) master.fenced = true;
}

void Masters::lose_step(const std::string& address) {
  for (auto& [id, master] : masters_) {
    if (master.address == address) master.cursor.at.reset();
  }
  past_[address].at.reset();
}

bool Masters::take_heartbeat(Master& master, std::uint16_t value) {
  Past& past = past_[master.address];
  const bool changed = value != master.heartbeat.value_or(past.heartbeat);
  master.heartbeat = past.heartbeat = value;
  return changed;
}

void Masters::drop_silent(Nanoseconds now, Nanoseconds longest) {
  std::erase_if(masters_, [=](const auto& entry) { return now - entry.second.asked_at >= longest; });
}

}  // namespace softgrip::plc
