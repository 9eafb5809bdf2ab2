// textbook-rig simulates fingers of one textbook world behind the board of config/boards/softgrip-sim.yaml,
// in real time.
//
//   Usage: textbook-rig --seed N --make NAME [--fingers 3]
//
// Listens on a free port of the loopback interface and prints it: "listening on 127.0.0.1:PORT". All fingers
// have the same parameters, and each has its own valve. So several controllers can run at the same time and
// can be compared. Output i commands finger i (0 to 10 V for 0 to 100 kPa). Input i is the sensor of finger i
// (0 to 10 V for -5 to 45 mm), and input 4 + i is the pressure of finger i. Ends when its client disconnects.
#include <arpa/inet.h>
#include <modbus/modbus.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "finger.h"
#include "valve.h"
#include "world.h"

namespace {

constexpr double valve_step_s = 0.00025, finger_step_s = 0.002, supply_kpa = 200;
constexpr double noise_mm = 0.04, pressure_noise_kpa = 0.05;
constexpr int inputs_at = 0, pressures_at = 4, read_back_at = 24, outputs_at = 256, registers = 300;
constexpr int most_fingers = 4;

struct Arguments {
  std::uint64_t seed = 1;
  std::string make = "play";
  int fingers = 3;
};

Arguments arguments(int argc, char** argv) {
  Arguments a;
  worlds::Options options;
  options.value("--seed", a.seed);
  options.value("--make", a.make);
  options.value("--fingers", [&a](const std::string& text) { a.fingers = std::stoi(text); });
  options.read(argc, argv);
  if (a.fingers < 1 || a.fingers > most_fingers) throw std::invalid_argument("1 to 4 fingers");
  return a;
}

/// One finger and its valve. The command is constant during a simulation step.
class Plant {
 public:
  explicit Plant(const textbook::World& world) : valve_(world.valve), finger_(world.finger) {}
  void step(double command_kpa) {
    const double before_kpa = pressure_kpa();
    for (double t = 0; t < finger_step_s - valve_step_s / 2; t += valve_step_s)
      valve_.step(command_kpa, supply_kpa, valve_step_s);
    displacement_mm_ = finger_.step(0.5 * (before_kpa + pressure_kpa()), finger_step_s);
  }
  double pressure_kpa() const { return valve_.gauge_kpa(); }
  double displacement_mm() const { return displacement_mm_; }

 private:
  textbook::Valve valve_;
  textbook::Finger finger_;
  double displacement_mm_ = 0;
};

struct FreeContext {
  void operator()(modbus_t* context) const { modbus_free(context); }
};
struct FreeMapping {
  void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
};

class Rig {
 public:
  Rig(const textbook::World& world, int fingers, std::uint64_t seed)
      : plants_(static_cast<std::size_t>(fingers), Plant(world)),
        mapping_(modbus_mapping_new(0, 0, registers, 0)),
        random_(seed) {
    if (!mapping_) throw std::runtime_error("there is not enough memory for the Modbus registers");
  }

  modbus_mapping_t* mapping() const { return mapping_.get(); }

  /// Simulates the time from the last call of this function until now. Updates the inputs of the board.
  void follow() {
    const auto now = std::chrono::steady_clock::now();
    for (; at_ + step_ <= now; at_ += step_) {
      for (std::size_t i = 0; i < plants_.size(); ++i) plants_[i].step(10 * volts(outputs_at, i));
    }
    for (std::size_t i = 0; i < plants_.size(); ++i) {
      const double y = plants_[i].displacement_mm() + noise_mm * normal_(random_);
      const double p = plants_[i].pressure_kpa() + pressure_noise_kpa * normal_(random_);
      set_volts(inputs_at, i, (y + 5) / 5);
      set_volts(inputs_at + 2 * pressures_at, i, p / 10);
      set_volts(read_back_at, i, volts(outputs_at, i));
    }
  }

 private:
  // Returns two registers as one float value. The first register contains the high word. The function does
  // not use the conversions of libmodbus, because they differ between the versions of libmodbus.
  double volts(int at, std::size_t i) const {
    const std::uint16_t* words = registers_of(at, i);
    return static_cast<double>(std::bit_cast<float>((static_cast<std::uint32_t>(words[0]) << 16) | words[1]));
  }
  void set_volts(int at, std::size_t i, double volts) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(volts));
    std::uint16_t* words = registers_of(at, i);
    words[0] = static_cast<std::uint16_t>(bits >> 16);
    words[1] = static_cast<std::uint16_t>(bits);
  }
  std::uint16_t* registers_of(int at, std::size_t i) const {
    return mapping_->tab_registers + at + 2 * static_cast<int>(i);
  }

  static constexpr std::chrono::microseconds step_{2000};
  std::vector<Plant> plants_;
  std::unique_ptr<modbus_mapping_t, FreeMapping> mapping_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{0, 1};
  std::chrono::steady_clock::time_point at_ = std::chrono::steady_clock::now();
};

int port_of(int socket) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("the address of the socket cannot be read");
  return ntohs(address.sin_port);
}

int run(const Arguments& a) {
  Rig rig(textbook::draw_world(a.make, a.seed), a.fingers, a.seed);
  const std::unique_ptr<modbus_t, FreeContext> context(modbus_new_tcp("127.0.0.1", 0));
  int listening = context ? modbus_tcp_listen(context.get(), 1) : -1;
  if (listening < 0) throw std::runtime_error("cannot listen");
  std::cout << "listening on 127.0.0.1:" << port_of(listening) << std::endl;
  if (modbus_tcp_accept(context.get(), &listening) < 0) throw std::runtime_error("no client connected");
  std::vector<std::uint8_t> query(MODBUS_TCP_MAX_ADU_LENGTH);
  for (;;) {
    const int length = modbus_receive(context.get(), query.data());
    if (length < 0) break;
    rig.follow();
    if (length > 0 && modbus_reply(context.get(), query.data(), length, rig.mapping()) < 0) break;
  }
  close(listening);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return worlds::exit_code_of("textbook-rig", [&] { return run(arguments(argc, argv)); });
}
