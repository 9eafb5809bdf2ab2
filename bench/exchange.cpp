// Compares the durations of an exchange over loopback for two clients: the client of this project, and
// libmodbus. Both clients send the same requests. Each client has its own libmodbus server for each kind of
// exchange. Blocks of exchanges of one client alternate with blocks of the other client. Each client begins
// half of the rounds. The program prints percentiles of the durations of each client.
//
// An exchange takes longer if server and client run on different processors, because each request and each
// response must then wake a processor. Without the second argument, the kernel chooses the processor of each
// thread. The kernel often keeps this choice for many blocks. A difference between the medians (p50) may then
// be a difference between processors and not between clients. The columns "1 cpu" and "2 cpus" contain the
// medians of the exchanges on one and on two processors. The argument "one" keeps all threads on one
// processor, and "two" keeps servers and clients on different processors.
//
//   Usage: build/release/bench/exchange_bench [exchanges, default 20000] [any|one|two]

#include <modbus/modbus.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.h"
#include "drivers/modbus/modbus_board.h"
#include "tests/drivers/modbus/libmodbus_server.h"

namespace {

using namespace softgrip;
using drivers::ModbusBoard;
using drivers::test::LibmodbusServer;

constexpr std::size_t block = 100;

/// Lets a thread run only on the processor with the index `place` in the list of allowed processors.
void keep_on(pthread_t thread, int place) {
  cpu_set_t allowed;
  cpu_set_t chosen;
  CPU_ZERO(&chosen);
  if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) std::exit(1);
  for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &allowed) && place-- == 0) CPU_SET(cpu, &chosen);
  }
  if (::pthread_setaffinity_np(thread, sizeof chosen, &chosen) != 0) {
    std::fprintf(stderr, "this comparison needs two processors\n");
    std::exit(1);
  }
}

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
  const LibmodbusServer& server;
  std::function<bool()> exchange;
  std::vector<double> one_processor = {};   ///< durations of exchanges with server and client on one
                                            ///< processor [us]
  std::vector<double> two_processors = {};  ///< durations of exchanges with server and client on different
                                            ///< processors [us]
};

void run_block(Contender& contender) {
  const MonotonicClock clock;
  for (std::size_t i = 0; i < block; ++i) {
    const Nanoseconds before = clock.now();
    if (!contender.exchange()) {
      std::fprintf(stderr, "%s failed\n", contender.name.c_str());
      std::exit(1);
    }
    const Nanoseconds after = clock.now();
    const bool same = contender.server.processor() == ::sched_getcpu();
    (same ? contender.one_processor : contender.two_processors)
        .push_back(static_cast<double>(after - before) * 1e-3);
  }
}

double percentile(std::vector<double>& values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(Contender& contender) {
  std::vector<double>& one = contender.one_processor;
  std::vector<double>& two = contender.two_processors;
  std::vector<double> all = one;
  all.insert(all.end(), two.begin(), two.end());
  std::printf("%-26s %8.1f %8.1f %8.1f %8.1f %8.1f %7.0f %%\n", contender.name.c_str(), percentile(all, 0.5),
              percentile(all, 0.99), percentile(all, 0.999), percentile(one, 0.5), percentile(two, 0.5),
              100.0 * static_cast<double>(two.size()) / static_cast<double>(all.size()));
}

modbus_t* libmodbus_client(std::uint16_t port) {
  modbus_t* const context = ::modbus_new_tcp("127.0.0.1", port);
  if (::modbus_connect(context) != 0) std::exit(1);
  return context;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t exchanges = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 20000;
  const std::string_view processors = argc > 2 ? argv[2] : "any";
  if (exchanges == 0 || (processors != "any" && processors != "one" && processors != "two")) {
    std::fprintf(stderr, "usage: exchange_bench [exchanges] [any|one|two]\n");
    return 2;
  }
  std::array<LibmodbusServer, 4> servers;
  if (processors != "any") {
    for (LibmodbusServer& server : servers) keep_on(server.thread(), processors == "one" ? 0 : 1);
    keep_on(::pthread_self(), 0);
  }
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
      {"softgrip, write + read", servers[0], [&] { return exchange(pair); }},
      {"libmodbus, write + read", servers[2],
       [&] {
         return ::modbus_write_registers(peer_pair, 256, 2, out.data()) == 2 &&
                ::modbus_read_registers(peer_pair, 0, 2, in.data()) == 2;
       }},
      {"softgrip, function 23", servers[1], [&] { return exchange(single); }},
      {"libmodbus, function 23", servers[3],
       [&] {
         return ::modbus_write_and_read_registers(peer_single, 256, 2, out.data(), 0, 2, in.data()) == 2;
       }},
  };
  for (std::size_t done = 0; done < exchanges; done += block) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      run_block(contenders[(i + done / block) % contenders.size()]);
    }
  }
  std::printf("%zu exchanges each over loopback [us]\n%-26s %8s %8s %8s %8s %8s %9s\n", exchanges, "", "p50",
              "p99", "p99.9", "1 cpu", "2 cpus", "on 2 cpus");
  for (Contender& contender : contenders) print(contender);
  std::printf("%s\n%s\n", pair.budget().explanation.c_str(), single.budget().explanation.c_str());
  for (modbus_t* const peer : {peer_pair, peer_single}) {
    ::modbus_close(peer);
    ::modbus_free(peer);
  }
}
