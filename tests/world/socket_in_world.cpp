#include "tests/world/socket_in_world.h"

#include <chrono>
#include <thread>
#include <utility>

namespace softgrip::world {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

SocketInWorld::SocketInWorld(daemon::StatusSources sources, rig::SocketSettings settings,
                             std::shared_ptr<const daemon::SequenceLoader> loader,
                             const daemon::EventLog& events)
    : api_(sources, std::move(settings), std::move(loader), events,
           [this](daemon::ClientId client, std::string_view line, bool) {
             if (const auto said = said_.find(client); said != said_.end())
               said->second.push_back(Json::parse(line));
             return true;
           }) {}

daemon::ClientId SocketInWorld::connect() {
  said_[++last_] = {};
  api_.on_opened(last_, daemon::Role::operate);
  return last_;
}

void SocketInWorld::hang_up(daemon::ClientId client) {
  arrivals_.push_back({client, {}});
  said_.erase(client);
}

void SocketInWorld::say(daemon::ClientId client, const Json& line) {
  arrivals_.push_back({client, line});
}

std::vector<Json> SocketInWorld::hear(daemon::ClientId client) {
  return std::exchange(said_[client], {});
}

void SocketInWorld::take(const Arrival& arrival, Nanoseconds now) {
  if (!arrival.line) return api_.on_closed(arrival.client);
  on_line(*arrival.line);
  api_.on_line(arrival.client, arrival.line->dump(), now);
  // The sequence loader runs in a real thread, so wait until it has finished. The simulated time does not
  // advance during this wait.
  while (api_.is_loading()) {
    std::this_thread::sleep_for(std::chrono::microseconds(20));
    api_.update(now);
  }
}

void SocketInWorld::serve(Nanoseconds now) {
  // Before the lines of the clients, send the periodic messages that are due. Their contents then do not
  // depend on the number of lines.
  api_.update(now);
  api_.update(now);
  while (!arrivals_.empty()) {
    const Arrival arrival = std::move(arrivals_.front());
    arrivals_.pop_front();
    take(arrival, now);
  }
  api_.update(now);
}

}  // namespace softgrip::world
