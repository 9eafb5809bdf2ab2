#include "tools/plc/gateway.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/grid.h"
#include "drivers/modbus_server/listener.h"
#include "tools/plc/server.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace softgrip::plc::gateway_test {
namespace {

/// A gateway whose daemon is not there.
class GatewayAlone : public ::testing::Test {
 protected:
  static Settings shipped_without_daemon() {
    document::Problems problems;
    Settings settings = *load_settings(SOFTGRIP_SOURCE_DIR "/config/plc.yaml", problems);
    settings.socket = "/nowhere/softgripd.sock";
    return settings;
  }
  void write(Name name, std::uint16_t value) {
    modbus::Request request{1, 1, {6}};
    modbus::append_word(request.pdu, settings_.registers.at(name));
    modbus::append_word(request.pdu, value);
    static_cast<void>(gateway_.serve(request, now_));
  }
  std::uint16_t read(Name name) {
    modbus::Request request{1, 1, {3}};
    modbus::append_word(request.pdu, settings_.registers.at(name));
    modbus::append_word(request.pdu, 1);
    const modbus::Reply reply = gateway_.serve(request, now_);
    const modbus::Bytes& frame = reply.pieces.at(0).bytes;
    return modbus::word_at(frame, frame.size() - 2);
  }

  Settings settings_ = shipped_without_daemon();
  Gateway gateway_{settings_};
  Nanoseconds now_ = ns_per_s;
};

TEST_F(GatewayAlone, RefusesEachCommandOnce) {
  write(Name::command_counter, 0);
  gateway_.look_after(now_);
  EXPECT_TRUE(gateway_.lines_to_daemon().empty());
  write(Name::command, 3);
  EXPECT_EQ(read(Name::outcome), static_cast<int>(Outcome::none));
  write(Name::command_counter, 1);
  EXPECT_EQ(read(Name::done_counter), 1);
  EXPECT_EQ(read(Name::outcome), static_cast<int>(Outcome::refused));
  EXPECT_EQ(read(Name::reason), static_cast<int>(Reason::no_daemon));
  write(Name::command, 77);
  write(Name::command_counter, 2);
  EXPECT_EQ(read(Name::reason), static_cast<int>(Reason::no_such_command));
}

/// It aborts where a promise is broken.
TEST_F(GatewayAlone, AnswersTheSeedsOfTheFuzzTargetWholeAndCutOff) {
  std::size_t seeds = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SOFTGRIP_SOURCE_DIR "/tests/tools/plc/plc_request_corpus")) {
    const std::string seed = *read_file(entry.path(), 65536);
    for (std::size_t length = 0; length <= seed.size(); ++length)
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(seed.data()), length);
    ++seeds;
  }
  EXPECT_GE(seeds, 5U);
}

TEST_F(GatewayAlone, TellsAMasterThatBeatsFromOneThatFellSilent) {
  EXPECT_EQ(read(Name::master), 0);
  write(Name::master_heartbeat, 5);
  EXPECT_EQ(read(Name::master), 1);
  now_ += nanoseconds(settings_.silence_s) + 1;
  EXPECT_EQ(read(Name::master), 2);
  EXPECT_FALSE(gateway_.hears_master(now_));
  write(Name::command_counter, 0);
  write(Name::command, 1);
  write(Name::recipe, 1);
  write(Name::command_counter, 1);
  EXPECT_EQ(read(Name::reason), static_cast<int>(Reason::master_silent));
  write(Name::master_heartbeat, 6);
  EXPECT_EQ(read(Name::master), 1);
}

TEST_F(GatewayAlone, BeatsItself) {
  const std::uint16_t before = read(Name::heartbeat);
  now_ += ns_per_s;
  EXPECT_EQ(read(Name::heartbeat), before + 10);
}

TEST(Server, LetsInWhoIsOnTheList) {
  const auto listener = modbus::listen_tcp("127.0.0.1", 0);
  ASSERT_TRUE(listener);
  Descriptor client(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ASSERT_EQ(::getsockname(listener->socket.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  ASSERT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
  const Descriptor accepted = modbus::accept_client(listener->socket);
  ASSERT_TRUE(accepted);
  EXPECT_TRUE(is_allowed(accepted.get(), {"192.168.1.9", "127.0.0.1"}));
  EXPECT_FALSE(is_allowed(accepted.get(), {"192.168.1.9"}));
  EXPECT_FALSE(is_allowed(accepted.get(), {}));
}

}  // namespace
}  // namespace softgrip::plc::gateway_test
