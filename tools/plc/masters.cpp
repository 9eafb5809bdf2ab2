#include "tools/plc/masters.h"

namespace softgrip::plc {

Command command_in(const Written& written) noexcept {
  const auto word = [&](Name name) { return written[static_cast<std::size_t>(name)]; };
  return {word(Name::command), word(Name::recipe), word(Name::squeeze), word(Name::speed),
          word(Name::displacement)};
}

std::optional<Masters::Id> Masters::admit(const std::string& address, Nanoseconds now) {
  if (masters_.size() >= most_) return std::nullopt;
  Master& master = masters_[++last_id_];
  master.address = address;
  master.asked_at = now;
  if (const auto past = past_.find(address); past != past_.end()) {
    master.cursor.at = past->second.at;
    master.heartbeat = past->second.heartbeat;
  }
  return last_id_;
}

Master* Masters::find(Id id) noexcept {
  const auto found = masters_.find(id);
  return found == masters_.end() ? nullptr : &found->second;
}

void Masters::drop_halves(Id except) {
  std::erase_if(masters_, [except](const auto& entry) { return entry.first != except && entry.second.half; });
}

void Masters::drop_silent(Nanoseconds now, Nanoseconds longest) {
  std::erase_if(masters_, [=](const auto& entry) { return now - entry.second.asked_at >= longest; });
}

}  // namespace softgrip::plc
