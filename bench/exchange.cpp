// Measures the duration of a Modbus exchange over the loopback interface. For comparison, the client of
// libmodbus sends the same requests to the same server. Blocks of exchanges of the two clients alternate
// within the same seconds. The program prints the percentiles of both clients.
//
//   build/release/bench/exchange_bench [exchanges, default 20000]

#include <modbus/modbus.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "drivers/modbus/modbus_board.h"
#include "rig/board_map_file.h"

namespace {

using namespace softgrip;
using drivers::ModbusBoard;

constexpr std::size_t block = 100;

/// A Modbus server of libmodbus in a thread. Each server serves one client at a time.
class Server {
 public:
  Server() : context_(::modbus_new_tcp("127.0.0.1", 0)), mapping_(::modbus_mapping_new(64, 64, 512, 64)) {
    listener_ = ::modbus_tcp_listen(context_, 1);
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  Server(Server&&) = delete;
  Server& operator=(Server&&) = delete;
  ~Server() {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
    ::modbus_mapping_free(mapping_);
    ::modbus_free(context_);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void serve() {
    std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> request{};
    while (::modbus_tcp_accept(context_, &listener_) >= 0) {
      for (int size = ::modbus_receive(context_, request.data()); size >= 0;
           size = ::modbus_receive(context_, request.data())) {
        ::modbus_reply(context_, request.data(), size, mapping_);
      }
      ::modbus_close(context_);
    }
  }

  modbus_t* context_;
  modbus_mapping_t* mapping_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

/// Returns the board map for both clients: two integer outputs from register 256 and two integer inputs from
/// register 0.
drivers::BoardMap map_with(bool fc23) {
  drivers::BoardMap map;
  map.name = "bench";
  map.inputs.registers = {3, 0, 2, drivers::RegisterKind::uint16};
  map.inputs.scaling = {0, -10, 65535, 10};
  map.outputs.registers = {16, 256, 2, drivers::RegisterKind::uint16};
  map.outputs.scaling = {0, 0, 4095, 10};
  map.outputs.raw_max = 4095;
  map.has_fc23 = fc23;
  return map;
}

std::vector<drivers::ChannelWiring> wiring() {
  std::vector<drivers::ChannelWiring> channels(2);
  for (std::size_t i = 0; i < 2; ++i) {
    channels[i].name = std::to_string(i);
    channels[i].valve = {i, drivers::ElectricalUnit::volt, {0, 0, 10, 100}};
    channels[i].displacement = {i, drivers::ElectricalUnit::volt, {0, 0, 10, 50}, -11, 11, {}};
  }
  return channels;
}

drivers::ModbusSettings settings(std::uint16_t port, const drivers::BoardMap& map) {
  return {.links = {drivers::TcpAddress{"127.0.0.1", port}},
          .modules = {{.name = "bench", .map = map, .unit = 255}},
          .wiring = wiring()};
}

struct Contender {
  std::string name;
  std::function<bool()> exchange;
  std::vector<double> microseconds = {};
};

void run_block(Contender& contender) {
  const MonotonicClock clock;
  for (std::size_t i = 0; i < block; ++i) {
    const Nanoseconds before = clock.now();
    if (!contender.exchange()) {
      std::fprintf(stderr, "%s failed\n", contender.name.c_str());
      std::exit(1);
    }
    contender.microseconds.push_back(static_cast<double>(clock.now() - before) * 1e-3);
  }
}

void print(Contender& contender) {
  std::sort(contender.microseconds.begin(), contender.microseconds.end());
  const auto percentile = [&](double share) {
    return contender.microseconds[static_cast<std::size_t>(
        share * static_cast<double>(contender.microseconds.size() - 1))];
  };
  std::printf("%-34s %8.1f %8.1f %8.1f\n", contender.name.c_str(), percentile(0.5), percentile(0.99),
              percentile(0.999));
}

modbus_t* libmodbus_client(std::uint16_t port) {
  modbus_t* const context = ::modbus_new_tcp("127.0.0.1", port);
  if (::modbus_connect(context) != 0) std::exit(1);
  return context;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t exchanges = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 20000;
  std::array<Server, 4> servers;
  ModbusBoard pair(settings(servers[0].port(), map_with(false)));
  ModbusBoard single(settings(servers[1].port(), map_with(true)));
  if (pair.connect(std::chrono::seconds(5)) != drivers::BusStatus::ok ||
      single.connect(std::chrono::seconds(5)) != drivers::BusStatus::ok) {
    std::fprintf(stderr, "cannot connect: %s%s\n", pair.detail(), single.detail());
    return 1;
  }
  modbus_t* const peer_pair = libmodbus_client(servers[2].port());
  modbus_t* const peer_single = libmodbus_client(servers[3].port());

  const std::array<double, 2> commands{30, 40};
  std::array<model::Reading, 2> readings;
  const std::array<std::uint16_t, 2> out{1229, 1638};
  std::array<std::uint16_t, 2> in{};
  const auto exchange = [&](ModbusBoard& board) {
    return board.exchange(commands, readings, std::chrono::seconds(5)) == drivers::BusStatus::ok;
  };
  std::vector<Contender> contenders{
      {"softgrip, write + read", [&] { return exchange(pair); }},
      {"libmodbus, write + read",
       [&] {
         return ::modbus_write_registers(peer_pair, 256, 2, out.data()) == 2 &&
                ::modbus_read_registers(peer_pair, 0, 2, in.data()) == 2;
       }},
      {"softgrip, function 23", [&] { return exchange(single); }},
      {"libmodbus, function 23",
       [&] {
         return ::modbus_write_and_read_registers(peer_single, 256, 2, out.data(), 0, 2, in.data()) == 2;
       }},
  };
  for (std::size_t done = 0; done < exchanges; done += block) {
    for (Contender& contender : contenders) run_block(contender);
  }
  std::printf("%zu exchanges each over loopback [us]\n%-34s %8s %8s %8s\n", exchanges, "", "p50", "p99",
              "p99.9");
  for (Contender& contender : contenders) print(contender);
  std::printf("%s\n%s\n", pair.budget().explanation.c_str(), single.budget().explanation.c_str());
  for (modbus_t* const peer : {peer_pair, peer_single}) {
    ::modbus_close(peer);
    ::modbus_free(peer);
  }
}
