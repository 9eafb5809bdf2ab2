#include "tools/web/server.h"

#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "tools/web/client.h"

namespace softgrip::web {

namespace {

/// Longest time between two checks of the daemon, of the time limits and of the sessions.
constexpr Nanoseconds longest_pause = ns_per_s / 20;
constexpr Nanoseconds check_period = ns_per_s;
/// Largest number of connections that are accepted in one cycle, so that accepting does not delay the
/// connected clients.
constexpr int most_accepted = 32;
constexpr int no_place = 503;
/// Time limit for reading the health result. After this time, a collector gets the metrics with the previous
/// health result.
constexpr Nanoseconds patience_for_health = ns_per_s;
constexpr Nanoseconds patience_for_disk = 8 * ns_per_s;

/// Size of the send buffer of a socket [bytes]. Without a set size, the system would buffer megabytes for a
/// client that does not read. The system doubles the size that is set. The memory limit of the systemd unit
/// includes these buffers.
constexpr int kept_by_system = 65536;
constexpr std::size_t most_connections = 512;  // largest number of connections that the configuration file
                                               // may set
constexpr std::size_t own_memory = std::size_t{20} << 20U;
constexpr std::size_t memory_of_unit = std::size_t{128} << 20U;  // memory limit in
                                                                 // systemd/softgrip-web.service.in [bytes]
static_assert(own_memory + most_unsent +
                      most_connections * (2 * std::size_t{kept_by_system} + longest_head + longest_body) <
                  memory_of_unit,
              "the responses that clients have not read yet must fit into the memory of the service");

using Phase = Client::Phase;

}  // namespace

std::size_t descriptor_limit() noexcept {
  rlimit limit{};
  constexpr std::size_t usual = 1024;
  return ::getrlimit(RLIMIT_NOFILE, &limit) == 0 ? std::size_t{limit.rlim_cur} : usual;
}

Server::Server(const Settings& settings, Tokens tokens, std::string chart_js, Descriptor listener,
               Descriptor signals)
    : settings_(settings),
      places_(places_for(settings.max_connections, descriptor_limit())),
      gate_(settings, std::move(tokens)),
      site_(settings, gate_, state_, counts_, std::move(chart_js)),
      watch_(settings.look_socket, state_),
      commander_(settings.operate_socket),
      archive_(settings.recordings),
      entrance_(std::move(listener)),
      signals_(std::move(signals)) {}

void Server::run() {
  serve_until_signal();
  commander_.leave();
}

void Server::serve_until_signal() {
  net::PollSet polled;
  for (;; polled.clear()) {
    const auto signal = polled.add(signals_.get());
    const auto newcomer = polled.add(entrance_.descriptor(clock_.now()));
    polled.add(watch_.descriptor());
    polled.add(commander_.descriptor());
    const auto disk = polled.add(archive_.descriptor());
    for (Visitor& visitor : visitors_) {
      const Client& client = visitor.client;
      visitor.place = polled.add(client.descriptor(), !client.said_all(), client.has_to_send());
    }
    const auto outcome = polled.wait(longest_pause);
    if (outcome == net::PollSet::Outcome::too_many && give_up_places()) continue;
    if (outcome != net::PollSet::Outcome::over || polled[signal]) return;
    const Nanoseconds now = clock_.now();
    watch_.look_after(now);
    commander_.look_after(now);
    if (polled[disk]) archive_.hear();
    for (Visitor& visitor : visitors_) {
      if (!visitor.leaves) look_after(visitor, polled[visitor.place], now);
    }
    tell_news(now);
    remove_leaving();
    if (polled[newcomer]) accept(now);
    count();
  }
}

/// Reduces the largest number of connections and closes connections. Must be called if poll() fails because
/// it would watch more descriptors than the process may have. Returns false if there was no connection to
/// close. The failure of poll() then has another cause.
bool Server::give_up_places() {
  const std::size_t before = visitors_.size();
  places_ = places_for(settings_.max_connections, descriptor_limit());
  std::size_t number = 0;
  for (Visitor& visitor : visitors_) visitor.leaves = visitor.leaves || ++number > lingering_places(places_);
  remove_leaving();
  return visitors_.size() < before;
}

void Server::count() {
  const Crowd crowd = crowd_beside(nullptr);
  counts_.connections = visitors_.size();
  counts_.unsent = unsent_of(crowd.guests);
  counts_.followers =
      static_cast<std::size_t>(std::count_if(visitors_.begin(), visitors_.end(), [](const Visitor& visitor) {
        return visitor.client.phase() == Phase::following;
      }));
}

void Server::accept(Nanoseconds now) {
  for (int i = 0; i < most_accepted; ++i) {
    Descriptor socket = entrance_.accept(now);
    // If the number of free descriptors is too small for the next client, another connection is closed.
    if (entrance_.short_of_descriptors()) static_cast<void>(make_place(now));
    if (!socket) return;
    ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &kept_by_system, sizeof kept_by_system);
    if (visitors_.size() < places_ || make_place(now)) {
      visitors_.push_back({Client(std::move(socket), now), {}, {}, {}, 0, {}, 0, false});
      continue;
    }
    ++counts_.turned_away;
    const std::string refusal = Site::refusal(no_place);
    // Sends as many bytes of the refusal as the socket accepts at once, because the server does not wait for
    // this client.
    [[maybe_unused]] const ssize_t sent =
        ::send(socket.get(), refusal.data(), refusal.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
}

void Server::look_after(Visitor& visitor, net::PollSet::Events events, Nanoseconds now) {
  Client& client = visitor.client;
  if (events.input() || events.ended()) {
    visitor.leaves = !client.receive();
    if (!visitor.leaves && client.phase() == Phase::asking) {
      serve(visitor, now);
      // A client that has closed its sending side before the request was complete can never complete the
      // request, so it is removed.
      if (client.phase() == Phase::asking && client.said_all()) visitor.leaves = true;
    }
  }
  // A client that has closed its sending side has possibly disconnected and cannot receive the outcome of its
  // start request. The server therefore abandons this start request.
  if (client.said_all() && commander_.is_open_start(visitor.command)) visitor.leaves = true;
  if (client.phase() == Phase::waiting && !visitor.leaves) take_reply(visitor, now);
  if (client.phase() == Phase::loading && !visitor.leaves) take_piece(visitor);
  if (visitor.leaves) return;
  const bool speaks = client.phase() != Phase::asking && client.phase() != Phase::waiting;
  visitor.leaves = (speaks && !client.send_on(now)) || client.late(now);
  if (client.phase() == Phase::loading && !visitor.leaves) ask_for_piece(visitor);
}

void Server::serve(Visitor& visitor, Nanoseconds now) {
  const std::string& request = visitor.client.request();
  const Frame frame = frame_of(request);
  if (frame.state == Frame::State::incomplete) return;
  if (frame.state == Frame::State::refused) return refuse(visitor, frame.status, now);
  Outcome outcome = site_.serve(std::string_view(request).substr(0, frame.size), now);
  visitor.role = outcome.role;
  if (outcome.disk_request) return ask_disk(visitor, std::move(*outcome.disk_request), now);
  if (!outcome.command) return answer(visitor, std::move(outcome), now);
  const auto sent = commander_.send(std::move(*outcome.command), now);
  if (!sent) return answer(visitor, site_.serve(request, now, {.daemon = &sent.error()}), now);
  visitor.command = *sent;
  visitor.client.wait();
}

void Server::ask_disk(Visitor& visitor, DiskRequest disk_request, Nanoseconds now) {
  const bool is_brief = disk_request.kind == DiskRequest::Kind::health;
  if (!is_brief && !make_lingering_place(visitor, now)) return refuse(visitor, no_place, now);
  visitor.task = archive_.ask(std::move(disk_request));
  visitor.gives_up_at = now + (is_brief ? patience_for_health : patience_for_disk);
  visitor.client.wait();
}

void Server::answer(Visitor& visitor, Outcome outcome, Nanoseconds now) {
  Client& client = visitor.client;
  const Phase next = outcome.follower ? Phase::following : outcome.file ? Phase::loading : Phase::answering;
  if (next != Phase::answering && !make_lingering_place(visitor, now)) return refuse(visitor, no_place, now);
  if (outcome.follower) visitor.follower = std::move(*outcome.follower);
  visitor.download = {std::move(outcome.file), 0, nullptr};
  ++counts_.answers[outcome.status];
  client.answer(std::move(outcome.bytes), next, now);
  visitor.leaves = !client.send_on(now);
  if (visitor.leaves || client.unsent() == 0) return;
  // The socket did not accept all bytes, so the connection becomes a lingering connection until the remaining
  // bytes are sent.
  visitor.leaves = !make_lingering_place(visitor, now) || !make_room(&visitor, visitor.role);
  if (visitor.leaves) client.drop_unsent();
}

void Server::refuse(Visitor& visitor, int status, Nanoseconds now) {
  Outcome outcome;
  outcome.bytes = Site::refusal(status);
  outcome.status = status;
  answer(visitor, std::move(outcome), now);
}

void Server::take_reply(Visitor& visitor, Nanoseconds now) {
  const std::string& request = visitor.client.request();
  if (!visitor.task) {
    const auto said = commander_.take_answer(visitor.command, now);
    if (said) answer(visitor, site_.serve(request, now, {.daemon = &*said}), now);
    return;
  }
  const bool done = visitor.task->done();
  if (!done && now < visitor.gives_up_at) return;
  const auto task = std::exchange(visitor.task, nullptr);
  if (done && task->request().kind == DiskRequest::Kind::health) state_.take_health(task->health());
  answer(visitor, site_.serve(request, now, {.disk = task.get()}), now);
}

void Server::take_piece(Visitor& visitor) {
  Download& download = visitor.download;
  if (!download.piece || !download.piece->done()) return;
  const auto piece = std::exchange(download.piece, nullptr);
  const auto bytes = std::string_view(piece->text()).substr(0, download.file->size - download.read);
  download.read += bytes.size();
  // If the file has become shorter since the response began, it has fewer bytes than the head of the response
  // has announced. The client is then disconnected.
  visitor.leaves = bytes.empty() || !visitor.client.add(bytes);
  if (download.read == download.file->size) visitor.client.finish();
}

/// Requests the next piece of a file if the previous piece was sent and memory is available. If there is too
/// little memory, the download waits, so that no other client must be disconnected.
void Server::ask_for_piece(Visitor& visitor) {
  Download& download = visitor.download;
  if (download.piece || visitor.client.has_to_send() || counts_.unsent + Archive::piece > most_unsent) return;
  counts_.unsent += Archive::piece;
  download.piece = archive_.ask({.kind = DiskRequest::Kind::piece, .from = download.file});
}

/// Returns true if the reader of a stream has the same role now as when the stream began.
bool Server::still_may(const Follower& follower, Nanoseconds now) {
  const auto role = gate_.admit(follower.credentials, false, now);
  return role && *role == follower.role;
}

void Server::tell_news(Nanoseconds now) {
  const std::string news = state_.take_news();
  const bool check = now - checked_at_ > check_period;
  if (check) checked_at_ = now;
  if (news.empty() && !check) return;
  for (Visitor& visitor : visitors_) {
    Client& client = visitor.client;
    if (client.phase() != Phase::following || visitor.leaves) continue;
    if (!check || still_may(visitor.follower, now)) {
      visitor.leaves = !client.add(news) || !client.send_on(now);
    } else {
      client.finish();
      visitor.leaves = !client.add("event: ended\ndata: null\n\n");
    }
  }
  static_cast<void>(make_room(nullptr, Role::operate));
}

void Server::remove_leaving() {
  std::erase_if(visitors_, [this](const Visitor& visitor) {
    if (visitor.leaves && visitor.command != 0) commander_.forget(visitor.command);
    return visitor.leaves;
  });
}

Guest Server::guest_of(const Visitor& visitor) {
  const Client& client = visitor.client;
  const std::size_t unsent = client.unsent() + (visitor.download.piece ? Archive::piece : 0);
  Guest guest{Guest::Stay::lingering, visitor.role, client.moved_at(), unsent};
  if (client.phase() == Phase::asking) {
    guest.stay = Guest::Stay::asking;
    guest.moved_at = client.came_at();
  } else if (client.phase() == Phase::waiting) {
    const bool is_brief = !visitor.task || visitor.task->request().kind == DiskRequest::Kind::health;
    if (is_brief) guest.stay = Guest::Stay::brief;
  } else if (client.phase() == Phase::answering && unsent == 0) {
    guest.stay = Guest::Stay::brief;
  }
  return guest;
}

Server::Crowd Server::crowd_beside(const Visitor* visitor) {
  Crowd crowd;
  for (Visitor& other : visitors_) {
    if (&other == visitor || other.leaves) continue;
    crowd.guests.push_back(guest_of(other));
    crowd.visitors.push_back(&other);
  }
  return crowd;
}

/// Marks the visitor for removal at the end of the cycle. Frees the visitor's unsent bytes at once, because
/// many responses may be created before the end of the cycle.
void Server::turn_away(Visitor& visitor) {
  visitor.leaves = true;
  visitor.client.drop_unsent();
  ++counts_.turned_away;
}

bool Server::make_place(Nanoseconds now) {
  const Crowd crowd = crowd_beside(nullptr);
  const Victim victim = gives_way_to_newcomer(crowd.guests, now);
  if (!victim) return false;
  turn_away(*crowd.visitors[*victim]);
  remove_leaving();
  return true;
}

bool Server::make_lingering_place(const Visitor& visitor, Nanoseconds now) {
  const Crowd crowd = crowd_beside(&visitor);
  const auto lingering = std::count_if(crowd.guests.begin(), crowd.guests.end(), [](const Guest& guest) {
    return guest.stay == Guest::Stay::lingering;
  });
  if (static_cast<std::size_t>(lingering) < lingering_places(places_)) return true;
  const Victim victim = gives_way_to_lingering(crowd.guests, visitor.role, now);
  if (!victim) return false;
  turn_away(*crowd.visitors[*victim]);
  return true;
}

bool Server::make_room(const Visitor* visitor, Role role) {
  for (;;) {
    const Crowd crowd = crowd_beside(visitor);
    const std::size_t unsent = unsent_of(crowd.guests) + (visitor != nullptr ? visitor->client.unsent() : 0);
    if (unsent <= most_unsent) return true;
    const Victim victim = gives_way_for_bytes(crowd.guests, role);
    if (!victim) return false;
    turn_away(*crowd.visitors[*victim]);
  }
}

}  // namespace softgrip::web
