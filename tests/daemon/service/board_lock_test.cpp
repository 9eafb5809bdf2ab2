#include "daemon/service/board_lock.h"

#include <gtest/gtest.h>

#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <functional>

#include "base/files.h"
#include "base/sha256.h"

namespace softgrip::daemon::board_lock_test {
namespace {

rig::RigFile rig_at(const std::string& host, std::uint16_t port, std::uint8_t unit = 1) {
  drivers::ModbusSettings modbus;
  modbus.links.emplace_back(drivers::TcpAddress{host, port});
  drivers::ModbusModuleSettings module;
  module.unit = unit;
  module.map.outputs.registers.count = 2;
  modbus.modules.push_back(module);
  rig::RigFile rig;
  rig.board = modbus;
  return rig;
}

TEST(BoardLock, ABoardHasOneLockForAllNotationsOfTheAddress) {
  auto first = BoardLock::take(rig_at("::1", 40502));
  ASSERT_TRUE(first) << first.error();
  const auto second = BoardLock::take(rig_at("0:0::1", 40502));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find("modbus ::1 port 40502 unit 1"), std::string::npos) << second.error();
  EXPECT_NE(second.error().find("process " + std::to_string(getpid())), std::string::npos) << second.error();
  EXPECT_TRUE(BoardLock::take(rig_at("::1", 40503))) << "boards at different ports have different locks";
  EXPECT_TRUE(BoardLock::take(rig_at("::1", 40502, 2)))
      << "different units behind one gateway have different locks";
  *first = BoardLock();
  EXPECT_TRUE(BoardLock::take(rig_at("::1", 40502))) << "the lock must be free after its holder has ended";
}

TEST(BoardLock, AnIpv4MappedIpv6AddressIsTheSameBoard) {
  const auto first = BoardLock::take(rig_at("127.0.0.1", 40502));
  ASSERT_TRUE(first) << first.error();
  EXPECT_FALSE(BoardLock::take(rig_at("::ffff:127.0.0.1", 40502)));
  EXPECT_FALSE(BoardLock::take(rig_at("::FFFF:7f00:1", 40502)));
}

TEST(BoardLock, ASerialLineHasOneLockForAllUnits) {
  rig::RigFile one = rig_at("", 0, 1);
  rig::RigFile two = rig_at("", 0, 2);
  const auto device = [](rig::RigFile& rig) -> std::string& {
    auto& links = std::get<drivers::ModbusSettings>(rig.board).links;
    links = {drivers::SerialLine{}};
    return std::get<drivers::SerialLine>(links[0]).device;
  };
  device(one) = "/dev/null";
  device(two) = "/dev/../dev/null";
  const auto first = BoardLock::take(one);
  ASSERT_TRUE(first) << first.error();
  EXPECT_FALSE(BoardLock::take(two));
}

TEST(BoardLock, AConverterHasOneLockForAllNames) {
  const ScratchFolder scratch;
  const std::filesystem::path root = std::filesystem::canonical(scratch.path());
  for (const char* const address : {"1-0060", "1-0061"}) {
    const std::string node = std::string("iio:device") + address[5];
    std::filesystem::create_directories(root / "hardware" / address / node);
    std::filesystem::create_directory_symlink(root / "hardware" / address / node, root / node);
  }
  const auto rig_with = [&](const std::string& word) {
    drivers::IioSettings converters;
    converters.root = root.string();
    converters.outputs = {{word, "voltage0", 4095}};
    rig::RigFile rig;
    rig.board = converters;
    return rig;
  };
  const auto first = BoardLock::take(rig_with("1-0060"));
  ASSERT_TRUE(first) << first.error();
  EXPECT_FALSE(BoardLock::take(rig_with("iio:device0")));
  EXPECT_FALSE(BoardLock::take(rig_with((root / "iio:device0").string())));
  EXPECT_TRUE(BoardLock::take(rig_with("iio:device1")));
}

/// A child process that runs `body` and then waits until the test ends it.
class Holder {
 public:
  explicit Holder(const std::function<bool()>& body) {
    int ready[2];
    EXPECT_EQ(::pipe(ready), 0);
    process_ = ::fork();
    if (process_ == 0) {
      const char good = body() ? 1 : 0;
      if (::write(ready[1], &good, 1) != 1) ::_exit(1);
      for (;;) ::pause();
    }
    ::close(ready[1]);
    char good = 0;
    EXPECT_TRUE(::read(ready[0], &good, 1) == 1 && good == 1);
    ::close(ready[0]);
  }
  Holder(const Holder&) = delete;
  Holder& operator=(const Holder&) = delete;
  Holder(Holder&&) = delete;
  Holder& operator=(Holder&&) = delete;
  ~Holder() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  [[nodiscard]] pid_t process() const { return process_; }
  void stop() const {
    ::kill(process_, SIGSTOP);
    int status = 0;
    EXPECT_EQ(::waitpid(process_, &status, WUNTRACED), process_);
  }

 private:
  pid_t process_ = 0;
};

std::function<bool()> a_program_on(const rig::RigFile& rig) {
  return [rig] {
    static auto lock = BoardLock::take(rig);  // NOLINT: static, so that the lock is held until the process
                                              // ends
    return lock.has_value();
  };
}

/// Returns a function that changes to another user and listens on the address that locks the board. Every
/// user of the machine can listen on this address.
std::function<bool()> another_user_on(const std::string& board, int backlog) {
  return [board, backlog] {
    constexpr uid_t nobody = 65534;
    if (::setresgid(nobody, nobody, nobody) != 0 || ::setresuid(nobody, nobody, nobody) != 0) return false;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string key = "softgrip-board-" + sha256(board);
    std::memcpy(address.sun_path + 1, key.data(), key.size());
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + key.size());
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), length) != 0) return false;
    return backlog < 0 || ::listen(socket, backlog) == 0;
  };
}

TEST(BoardLock, ALockOfAnUntrustedUserIsIgnoredWithARemark) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can run this test as another user";
  const rig::RigFile rig = rig_at("127.0.0.1", 40511);
  for (const int backlog : {-1, 0, 5}) {
    const Holder other(another_user_on("modbus 127.0.0.1 port 40511 unit 1", backlog));
    const auto lock = BoardLock::take(rig);
    ASSERT_TRUE(lock) << lock.error();
    ASSERT_EQ(lock->remarks().size(), 1U);
    EXPECT_NE(lock->remarks()[0].find("has no permission to control the board"), std::string::npos)
        << lock->remarks()[0];
    EXPECT_FALSE(BoardLock::take(rig)) << "the lock must still exclude a second program of softgrip";
    EXPECT_FALSE(BoardLock::take(rig, LockPurpose::vent));
  }
}

TEST(BoardLock, ARemovedLockFileStillExcludesOtherPrograms) {
  const rig::RigFile rig = rig_at("127.0.0.1", 40512);
  const Holder holder(a_program_on(rig));
  const auto folder = RuntimeFolder::open();
  ASSERT_TRUE(folder) << folder.error();
  const std::string file =
      folder->path() + "/board-" + sha256("modbus 127.0.0.1 port 40512 unit 1") + ".lock";
  ASSERT_TRUE(std::filesystem::remove(file)) << file;
  const auto second = BoardLock::take(rig);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find("process " + std::to_string(holder.process())), std::string::npos)
      << second.error();
}

TEST(BoardLock, IsReleasedByAKilledProcessAndLeavesNoFile) {
  const rig::RigFile rig = rig_at("127.0.0.1", 40513);
  { const Holder killed(a_program_on(rig)); }
  const std::string name = "board-" + sha256("modbus 127.0.0.1 port 40513 unit 1") + ".lock";
  const auto folder = RuntimeFolder::open();
  ASSERT_TRUE(folder) << folder.error();
  {
    const auto lock = BoardLock::take(rig);
    ASSERT_TRUE(lock) << lock.error();
    EXPECT_TRUE(lock->remarks().empty());
    EXPECT_TRUE(std::filesystem::exists(folder->path() + "/" + name));
  }
  EXPECT_FALSE(std::filesystem::exists(folder->path() + "/" + name));
}

TEST(BoardLock, VentingOverridesOnlyTheLockOfAStoppedProcess) {
  const rig::RigFile rig = rig_at("127.0.0.1", 40514);
  const Holder holder(a_program_on(rig));
  EXPECT_FALSE(BoardLock::take(rig, LockPurpose::vent));
  holder.stop();
  EXPECT_FALSE(BoardLock::take(rig))
      << "a program that drives the board must wait until the stopped program has ended";
  const auto lock = BoardLock::take(rig, LockPurpose::vent);
  ASSERT_TRUE(lock) << lock.error();
  ASSERT_FALSE(lock->remarks().empty());
  EXPECT_NE(lock->remarks()[0].find("does not run"), std::string::npos) << lock->remarks()[0];
}

TEST(BoardLock, SimulatedBoardsAndInputModulesDriveNoBoard) {
  rig::RigFile simulated;
  simulated.board = simulation::SimulatedBoardSettings{};
  EXPECT_TRUE(driven_by(simulated).empty());
  rig::RigFile inputs = rig_at("127.0.0.1", 502);
  std::get<drivers::ModbusSettings>(inputs.board).modules[0].map.outputs.registers.count = 0;
  EXPECT_TRUE(driven_by(inputs).empty());
}

}  // namespace
}  // namespace softgrip::daemon::board_lock_test
