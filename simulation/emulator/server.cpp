#include "simulation/emulator/server.h"

#include <sys/signalfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>

namespace softgrip::simulation {
namespace {

constexpr std::size_t max_modbus_clients = 32;
constexpr std::size_t max_control_clients = 8;
constexpr std::size_t max_control_line = 1024;
constexpr std::size_t max_control_read = 512;
// Longest wait in poll(). A longer wait would delay the truth log and the scheduled faults.
constexpr std::chrono::milliseconds longest_wait{20};

}  // namespace

int Server::ControlClient::input() const noexcept {
  return socket ? socket.get() : STDIN_FILENO;
}

Server::Server(Emulator& emulator, ServerSockets sockets)
    : emulator_(emulator),
      sockets_(std::move(sockets)),
      acceptors_(std::make_move_iterator(sockets_.modbus.begin()),
                 std::make_move_iterator(sockets_.modbus.end())),
      control_acceptor_(std::move(sockets_.control)) {
  if (sockets_.standard_input) control_clients_.emplace_back();
}

void Server::run(const std::function<void()>& idle) {
  net::PollSet polled;
  std::vector<net::PollSet::Entry> links(acceptors_.size());
  while (!quit_) {
    plug_line();
    polled.clear();
    const auto signal = polled.add(sockets_.signals.get());
    // The descriptor of an acceptor that is closed or pauses is -1, for which poll() reports no events.
    const auto control = polled.add(control_acceptor_.descriptor(now()));
    for (std::size_t link = 0; link < links.size(); ++link)
      links[link] = polled.add(acceptors_[link].descriptor(now()));
    for (ControlClient& client : control_clients_) client.poll_entry = polled.add(client.input());
    for (Client& client : clients_)
      client.poll_entry = polled.add(client.connection.descriptor(), true, client.connection.blocked());
    const auto outcome = polled.wait(timeout());
    if (outcome == net::PollSet::Outcome::too_many_descriptors && give_up_client()) continue;
    if (outcome != net::PollSet::Outcome::done) return;

    emulator_.advance(now());
    for (ControlClient& client : control_clients_) {
      if (polled[client.poll_entry]) read_control(client);
    }
    std::erase_if(control_clients_, [](const ControlClient& client) { return !client.open; });
    std::erase_if(clients_, [&](Client& client) { return !serve(client, polled[client.poll_entry]); });
    if (polled[signal]) take_signal();
    if (polled[control]) accept_control();
    for (std::size_t link = 0; link < links.size(); ++link) {
      if (polled[links[link]]) accept_modbus(link);
    }
    count_clients();
    idle();
  }
}

/// Closes the connection of the newest client. The server calls this function if poll() fails because the
/// process has more descriptors than it may have.
bool Server::give_up_client() {
  if (sockets_.line || clients_.empty()) return false;
  clients_.pop_back();
  count_clients();
  return true;
}

/// Closes the serial line and removes its path while the fault `disconnect` is active. After the fault, opens
/// the line again under this path.
void Server::plug_line() {
  if (!sockets_.line || !clients_.empty()) return;
  if (sockets_.end && sockets_.end->taken()) sockets_.end.reset();
  if (!emulator_.reachable()) return;
  if (!sockets_.end) {
    auto end = SerialEnd::open(*sockets_.line);
    if (!end) return;
    sockets_.end = std::move(*end);
  }
  const WireTime wire_time = sockets_.end->wire_time();
  clients_.push_back({Connection(sockets_.end->take(), wire_time), 0, now()});
}

Nanoseconds Server::now() const {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
}

Nanoseconds Server::timeout() const {
  const Clock::time_point now = Clock::now();
  Clock::time_point wake = now + longest_wait;
  for (const Client& client : clients_) {
    const auto due = client.connection.next_due();
    if (due && !client.connection.blocked()) wake = std::min(wake, *due);
  }
  return std::max<Nanoseconds>(0, std::chrono::nanoseconds(wake - now).count());
}

bool Server::serve(Client& client, net::PollSet::Events events) {
  bool open = true;
  if (events.input() || events.hangup_or_error()) {
    open = client.connection.receive([&](const Request& request) {
      return emulator_.serve(now(), request, client.link, client.opened_at);
    });
  }
  return open && client.connection.send_due(Clock::now()) && emulator_.reachable();
}

void Server::accept_modbus(std::size_t link) {
  Descriptor client = acceptors_[link].accept(now());
  // If the fault `disconnect` is active, or if max_modbus_clients are already connected, the server accepts a
  // new client and closes its connection immediately.
  if (client && emulator_.reachable() && clients_.size() < max_modbus_clients) {
    const bool rtu = emulator_.wire() == Wire::rtu;  // true: RTU frames over TCP, as serial device servers
                                                     // transmit them
    clients_.push_back(
        {rtu ? Connection(std::move(client), WireTime{}) : Connection(std::move(client)), link, now()});
  }
}

void Server::count_clients() {
  for (std::size_t link = 0; link < std::max<std::size_t>(acceptors_.size(), 1); ++link) {
    const auto clients = std::count_if(clients_.begin(), clients_.end(),
                                       [link](const Client& client) { return client.link == link; });
    emulator_.count_clients(static_cast<std::size_t>(clients), link);
  }
}

void Server::accept_control() {
  Descriptor client = control_acceptor_.accept(now());
  if (client && control_clients_.size() < max_control_clients) {
    control_clients_.push_back({std::move(client), {}, true});
  }
}

void Server::take_signal() {
  signalfd_siginfo info{};
  if (::read(sockets_.signals.get(), &info, sizeof info) != static_cast<ssize_t>(sizeof info)) return;
  if (info.ssi_signo == SIGUSR1) {
    emulator_.trigger(Emulator::object_out, now());
  } else {
    quit_ = true;
  }
}

void Server::read_control(ControlClient& client) {
  const auto received = client.pending.receive(client.input(), max_control_read);
  while (const auto line = client.pending.next()) answer_control(client, *line);
  client.open = received != net::LineBuffer::Received::end && !client.pending.exceeds(max_control_line);
}

void Server::answer_control(const ControlClient& client, std::string_view line) {
  const ControlAnswer answer = control(emulator_, now(), line);
  quit_ = quit_ || answer.quit;
  const std::string text = answer.line + "\n";
  // A reply always fits into an empty buffer of the socket. The buffer is full only if a client does not read
  // its replies; further replies to this client are then lost.
  if (client.socket) {
    ::send(client.socket.get(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  } else if (::write(STDOUT_FILENO, text.data(), text.size()) < 0) {
    quit_ = errno == EPIPE;
  }
}

}  // namespace softgrip::simulation
