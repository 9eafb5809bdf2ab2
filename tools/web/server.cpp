#include "tools/web/server.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "drivers/modbus_server/listener.h"
#include "tools/web/request_frame.h"

namespace softgrip::web {

namespace {

/// The daemon, deadlines and sessions are looked after at least so often.
constexpr Nanoseconds longest_pause = ns_per_s / 20;
constexpr Nanoseconds check_period = ns_per_s;
/// Who is still asking after this time loses its place to one that comes, if there is no other.
constexpr Nanoseconds quick_question = ns_per_s / 2;
/// Taken from the queue of those who wait, in one turn: the others have theirs.
constexpr int most_accepted = 32;
constexpr int no_place = 503;
constexpr int kept_by_system = 65536;

using Phase = Client::Phase;

}  // namespace

Server::Server(const Settings& settings, Tokens tokens, std::string chart_js, Descriptor listener,
               Descriptor signals)
    : settings_(settings),
      gate_(settings, std::move(tokens)),
      site_(settings, gate_, state_, counts_, std::move(chart_js)),
      watch_(settings.look_socket, state_),
      commander_(settings.operate_socket),
      listener_(std::move(listener)),
      signals_(std::move(signals)) {}

void Server::run() {
  std::vector<pollfd> watched;
  constexpr std::size_t others = 4;
  const timespec pause{0, longest_pause};
  for (;;) {
    watched.assign({{signals_.get(), POLLIN, 0},
                    {listener_.get(), POLLIN, 0},
                    {watch_.descriptor(), POLLIN, 0},
                    {commander_.descriptor(), POLLIN, 0}});
    for (const Visitor& visitor : visitors_) {
      const int events = visitor.client.has_to_send() ? POLLIN | POLLOUT : POLLIN;
      watched.push_back({visitor.client.descriptor(), static_cast<short>(events), 0});
    }
    if (::ppoll(watched.data(), watched.size(), &pause, nullptr) < 0 && errno != EINTR) return;
    if (watched[0].revents != 0) return;
    const Nanoseconds now = clock_.now();
    watch_.look_after(now);
    commander_.look_after();
    auto found = watched.begin() + others;
    std::erase_if(visitors_, [&](Visitor& visitor) { return !look_after(visitor, (found++)->revents, now); });
    tell_news(now);
    if (watched[1].revents != 0) accept(now);
    counts_.connections = visitors_.size();
    counts_.followers = static_cast<std::size_t>(
        std::count_if(visitors_.begin(), visitors_.end(),
                      [](const Visitor& visitor) { return visitor.client.phase() == Phase::following; }));
  }
}

void Server::accept(Nanoseconds now) {
  for (int i = 0; i < most_accepted; ++i) {
    Descriptor socket = modbus::accept_client(listener_);
    if (!socket) return;
    // The system would keep megabytes for who does not read.
    ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &kept_by_system, sizeof kept_by_system);
    if (visitors_.size() < settings_.max_connections || make_place(now)) {
      visitors_.push_back({Client(std::move(socket), now), {}});
      continue;
    }
    ++counts_.turned_away;
    const std::string refusal = Site::refusal(no_place);
    // Whatever the socket takes at once: nobody waits for him.
    [[maybe_unused]] const ssize_t sent =
        ::send(socket.get(), refusal.data(), refusal.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
}

bool Server::make_place(Nanoseconds now) {
  const auto slow = std::find_if(visitors_.begin(), visitors_.end(), [now](const Visitor& visitor) {
    return visitor.client.phase() == Phase::asking && now - visitor.client.came_at() > quick_question;
  });
  if (slow == visitors_.end()) return false;
  ++counts_.turned_away;
  visitors_.erase(slow);
  return true;
}

bool Server::look_after(Visitor& visitor, short events, Nanoseconds now) {
  Client& client = visitor.client;
  if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) {
    if (!client.receive()) return false;
    if (client.phase() == Phase::asking) serve(visitor, now);
  }
  if (client.phase() == Phase::waiting) take_answer(visitor, now);
  const bool speaks = client.phase() == Phase::answering || client.phase() == Phase::following;
  return (!speaks || client.send_on(now)) && !client.late(now);
}

void Server::serve(Visitor& visitor, Nanoseconds now) {
  const std::string& request = visitor.client.request();
  const Frame frame = frame_of(request);
  if (frame.state == Frame::State::incomplete) return;
  if (frame.state == Frame::State::refused) return refuse(visitor, frame.status, now);
  Outcome outcome = site_.serve(std::string_view(request).substr(0, frame.size), now);
  if (!outcome.command) return answer(visitor, std::move(outcome), now);
  const auto sent = commander_.send(std::move(*outcome.command), now);
  if (sent) return visitor.client.wait_for(*sent);
  answer(visitor, site_.serve(request, now, &sent.error()), now);
}

void Server::answer(Visitor& visitor, Outcome outcome, Nanoseconds now) {
  const bool follows = outcome.follower.has_value();
  // Pages that stay open leave room for those that ask.
  if (follows && counts_.followers >= settings_.max_connections * 3 / 4)
    return refuse(visitor, no_place, now);
  if (follows) {
    ++counts_.followers;
    visitor.follower = std::move(*outcome.follower);
  }
  ++counts_.answers[outcome.status];
  visitor.client.answer(std::move(outcome.bytes), follows, now);
}

void Server::refuse(Visitor& visitor, int status, Nanoseconds now) {
  ++counts_.answers[status];
  visitor.client.answer(Site::refusal(status), false, now);
}

void Server::take_answer(Visitor& visitor, Nanoseconds now) {
  const auto said = commander_.take_answer(visitor.client.command(), now);
  if (said) answer(visitor, site_.serve(visitor.client.request(), now, &*said), now);
}

/// Whether somebody who reads along may still do what he might when he began.
bool Server::still_may(const Follower& follower, Nanoseconds now) {
  const auto role = gate_.admit(follower.credentials, false, now);
  return role && *role == follower.role;
}

void Server::tell_news(Nanoseconds now) {
  const std::string news = state_.take_news();
  const bool check = now - checked_at_ > check_period;
  if (check) checked_at_ = now;
  if (news.empty() && !check) return;
  std::erase_if(visitors_, [&](Visitor& visitor) {
    Client& client = visitor.client;
    if (client.phase() != Phase::following) return false;
    if (!check || still_may(visitor.follower, now)) return !client.add(news) || !client.send_on(now);
    client.finish();
    return !client.add("event: ended\ndata: null\n\n");
  });
}

}  // namespace softgrip::web
