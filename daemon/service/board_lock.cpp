#include "daemon/service/board_lock.h"

#include <sys/file.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/net/listener.h"
#include "base/periodic_schedule.h"
#include "base/sha256.h"
#include "daemon/service/trusted_user.h"
#include "drivers/iio/iio_device.h"

namespace softgrip::daemon {

namespace {

std::string real_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  return error ? path : real.string();
}

std::string name_of(const drivers::ModbusAddress& link, std::uint8_t unit) {
  if (const auto* tcp = std::get_if<drivers::TcpAddress>(&link))
    return fmt::format("modbus {} port {} unit {}", net::normal_address(tcp->host), tcp->port, unit);
  // A serial line has only one client (master), even if it reaches modules with different unit addresses.
  return "serial " + real_path(std::get<drivers::SerialLine>(link).device);
}

/// Returns a name for a converter. The name is independent of the notation that the rig file uses for the
/// converter.
std::string name_of(const std::vector<ComputerDevice>& there, const std::string& word,
                    const std::string& root) {
  const auto device = only_device(there, word, "converter");
  if (device)
    return "converter " +
           (device->word("address").empty() ? device->folder.string() : drivers::identity_of(*device));
  return fmt::format("converter {} of {}", word, real_path(root));
}

std::string key_of(const std::string& board) {
  return "board-" + sha256(board);
}

sockaddr_un address_of(const std::string& board, socklen_t& length) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string key = "softgrip-" + key_of(board);
  std::memcpy(address.sun_path + 1, key.data(), key.size());
  length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + key.size());
  return address;
}

/// Returns the process id as a text such as " (process 4711)"; empty if the process is unknown.
std::string in_brackets(pid_t process) {
  return process > 0 ? fmt::format(" (process {})", process) : "";
}

std::string taken(const std::string& board, pid_t process) {
  return fmt::format(
      "{}: another softgrip program drives this board{}; two clients (masters) would overwrite each other's "
      "outputs",
      board, in_brackets(process));
}

/// Returns the state letter of a process from /proc (R, S, D, T, ...); nothing if this user cannot see the
/// process.
std::optional<char> state_of(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string text;
  std::getline(file, text, '\0');
  const std::size_t name_end = text.rfind(") ");
  if (name_end == std::string::npos || name_end + 2 >= text.size()) return std::nullopt;
  return text[name_end + 2];
}

/// Returns true if the process was stopped, dead or blocked in a system call each time it was checked. Such a
/// process cannot drive a board.
bool stands_still(pid_t process) {
  constexpr int looks = 5;
  constexpr Nanoseconds pause = 50'000'000;
  for (int i = 0; i < looks; ++i) {
    const std::optional<char> state = process > 0 ? state_of(process) : std::nullopt;
    if (!state || std::string_view("DTtZX").find(*state) == std::string_view::npos) return false;
    sleep_until(monotonic_now() + pause);
  }
  return true;
}

/// Returns the process that locked the file. This process has written its id into the file. Returns 0 if the
/// id is unknown.
pid_t holder_of(int file) {
  std::array<char, 16> text{};
  if (::pread(file, text.data(), text.size() - 1, 0) <= 0) return 0;
  return static_cast<pid_t>(std::strtol(text.data(), nullptr, 10));
}

void write_holder(int file) {
  const std::string text = std::to_string(::getpid()) + "\n";
  // An error of the write is ignored. Without the process id, messages name no process, and the holder counts
  // as running.
  if (::ftruncate(file, 0) == 0) [[maybe_unused]]
    const ssize_t written = ::pwrite(file, text.data(), text.size(), 0);
}

/// Returns the process that has bound the name of a socket. Returns nothing if the process cannot be found,
/// because it does not listen on the socket or because its queue is full.
std::optional<Peer> holder_of(const sockaddr_un& address, socklen_t length) {
  // Between bind() and listen(), the process of a softgrip program cannot be found through the socket, so the
  // check is repeated.
  constexpr int attempts = 5;
  constexpr Nanoseconds pause = 2'000'000;
  for (int i = 0; i < attempts; ++i) {
    const Descriptor probe(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), length) == 0)
      return peer_of(probe.get());
    if (errno != ECONNREFUSED) return std::nullopt;
    sleep_until(monotonic_now() + pause);
  }
  return std::nullopt;
}

std::string standing_still(const std::string& board, pid_t process) {
  return fmt::format(
      "{}: the softgrip program that holds the lock of this board{} does not run: it is stopped or blocked",
      board, in_brackets(process));
}

/// Returns the sentence that reports a holder of the lock whose lock is ignored.
std::string without_right(const std::string& board, const std::optional<Peer>& holder) {
  if (holder && holder->trusted) return standing_still(board, holder->process);
  const std::string who =
      holder ? fmt::format("user {}{}", holder->user, in_brackets(holder->process)) : "an unknown program";
  return fmt::format(
      "{}: {} holds the lock of this board, but has no permission to control the board, so softgrip ignores "
      "the lock",
      board, who);
}

}  // namespace

std::vector<std::string> driven_by(const rig::RigFile& rig) {
  std::set<std::string> names;
  if (const auto* modbus = std::get_if<drivers::ModbusSettings>(&rig.board)) {
    for (const drivers::ModbusModuleSettings& module : modbus->modules) {
      if (module.map.outputs.registers.count > 0)
        names.insert(name_of(modbus->links[module.link], module.unit));
    }
  }
  if (const auto* converters = std::get_if<drivers::IioSettings>(&rig.board)) {
    const auto there = drivers::converters_in(converters->root);
    for (const drivers::IioTerminal& output : converters->outputs)
      names.insert(name_of(there, output.device, converters->root));
  }
  return {names.begin(), names.end()};
}

LockedFile::LockedFile(std::shared_ptr<const RuntimeFolder> folder, std::string name, Descriptor file)
    : folder_(std::move(folder)), name_(std::move(name)), file_(std::move(file)) {}

LockedFile& LockedFile::operator=(LockedFile&& other) noexcept {
  std::swap(folder_, other.folder_);
  std::swap(name_, other.name_);
  std::swap(file_, other.file_);
  return *this;
}

LockedFile::~LockedFile() {
  // Another program may have opened this file before its name is removed. That program detects that the name
  // is missing, and creates a new file.
  if (file_ && folder_->still_names(name_, file_.get())) folder_->remove(name_);
}

tl::expected<void, std::string> BoardLock::add_file(const std::shared_ptr<const RuntimeFolder>& folder,
                                                    const std::string& board, LockPurpose purpose) {
  const std::string name = key_of(board) + ".lock";
  for (;;) {
    auto file = folder->lock_file(name);
    if (!file && purpose == LockPurpose::drive) return tl::unexpected(file.error());
    if (!file) {
      remarks_.push_back(file.error());
      return {};
    }
    if (::flock(file->get(), LOCK_EX | LOCK_NB) != 0) {
      const pid_t process = holder_of(file->get());
      if (purpose != LockPurpose::vent || !stands_still(process))
        return tl::unexpected(taken(board, process));
      remarks_.push_back(standing_still(board, process));
      return {};
    }
    // If the previous holder ended between open() and flock(), it has removed the name of this file. In this
    // case the file must be opened again.
    if (!folder->still_names(name, file->get())) continue;
    write_holder(file->get());
    files_.emplace_back(folder, name, std::move(*file));
    return {};
  }
}

tl::expected<void, std::string> BoardLock::add_name(const std::string& board, LockPurpose purpose) {
  socklen_t length = 0;
  const sockaddr_un address = address_of(board, length);
  Descriptor held(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (bind(held.get(), reinterpret_cast<const sockaddr*>(&address), length) == 0 &&
      listen(held.get(), SOMAXCONN) == 0) {  // the kernel can report the holder of a socket only if the
                                             // socket listens
    names_.push_back(std::move(held));
    return {};
  }
  if (errno != EADDRINUSE) return tl::unexpected(fmt::format("{}: {}", board, std::strerror(errno)));
  const std::optional<Peer> holder = holder_of(address, length);
  const bool counts =
      holder && holder->trusted && !(purpose == LockPurpose::vent && stands_still(holder->process));
  if (counts) return tl::unexpected(taken(board, holder->process));
  remarks_.push_back(without_right(board, holder));
  return {};
}

tl::expected<BoardLock, std::string> BoardLock::take(const rig::RigFile& rig, LockPurpose purpose) {
  BoardLock lock;
  const std::vector<std::string> boards = driven_by(rig);
  if (boards.empty()) return lock;
  auto folder = RuntimeFolder::open();
  if (!folder && purpose == LockPurpose::drive)
    return tl::unexpected("the lock of the board cannot be acquired: " + folder.error());
  if (!folder) lock.remarks_.push_back("the lock of the board cannot be acquired: " + folder.error());
  const auto shared = folder ? std::make_shared<const RuntimeFolder>(std::move(*folder)) : nullptr;
  for (const std::string& board : boards) {
    if (shared) {
      if (const auto added = lock.add_file(shared, board, purpose); !added)
        return tl::unexpected(added.error());
    }
    if (const auto added = lock.add_name(board, purpose); !added) return tl::unexpected(added.error());
  }
  return lock;
}

}  // namespace softgrip::daemon
