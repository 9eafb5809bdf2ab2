#include "rig/rig_keys.h"

namespace softgrip::rig {

namespace {

using document::optional;
using document::required;

void declare_gpio(RigKeys& keys) {
  keys.gpio = {
      required("debounce_s", &GpioSettings::debounce_s, {0.0001, 0.1},
               "time for which a new level of an input line must be constant before the daemon accepts it"),
      required("stale_after_s", &GpioSettings::stale_after_s, {0.01, 10},
               "time without a reading of the lines after which F502 latches; also the time without a cycle "
               "of the control loop after which the enable output is switched off"),
      optional("look_interval_s", &GpioSettings::look_interval_s, {0.001, 0.1},
               "interval at which the daemon reads the lines even if no edge occurs; at most a quarter of "
               "`stale_after_s`")};
  using Line = drivers::GpioLineSettings;
  keys.gpio_line = {
      required("chip", &Line::chip, {}, "[word that identifies one chip](#devices-of-the-computer)"),
      optional("line", &Line::line, {}, "name of the line"),
      optional("offset", &Line::offset, {0, 65535},
               "number of the line in the chip, counted from 0; replaces `line`"),
      required("active", &Line::active_low, {"high", "low"}, "level at which the line is active")};
  keys.gpio_input = {
      optional("bias", &Line::bias, drivers::gpio_bias_names, "only for inputs: pull resistor of the line")};
  keys.gpio_enable = {required("on_fault", &GpioSettings::keeps_enable_on_fault, {"drop", "keep"},
                               "only for `enable`: the output is switched off (`drop`) or stays on (`keep`) "
                               "during a fault other than F501 and F502")};
}

void declare_modbus(RigKeys& keys) {
  keys.exchange = {required("exchange_deadline_s", &LoopSettings::exchange_deadline_s, {1e-4, 1},
                            "time limit of an exchange; after this time, the exchange has failed and "
                            "softgripd opens a new session")};
  keys.connecting = {
      required("connect_deadline_s", &ReconnectSettings::connect_deadline, {1e-3, 30},
               "time limit for opening a session"),
      required("first_pause_s", &ReconnectSettings::first_pause, {1e-3, 60},
               "first pause between two connection attempts; the pause doubles after each attempt"),
      required("longest_pause_s", &ReconnectSettings::longest_pause, {1e-3, 600},
               "longest pause between two connection attempts")};
  keys.budget = {optional("accept_over_budget", &RigFile::accept_over_budget, {},
                          "`true`: accept a `rate_hz` that exceeds the bus budget")};
  keys.module = {{"map", "a path", "", "[board map](board-map.md)"},
                 {"unit", "0 to 255", "", "Modbus unit id of the board; with RTU frames, 1 to 247"},
                 {"modules", "list", "none",
                  "list of the modules of a board with several modules; replaces `map` and `unit`"}};
  using drivers::LinkHabits;
  keys.habits = {
      optional("settle_s", &LinkHabits::settle_s, {0, 30},
               "waiting time between the opening of a connection and the first request; must be below "
               "`connect_deadline_s`"),
      optional(
          "repeat_after_s", &LinkHabits::repeat_after_s, {0.001, 1},
          "time without a response after which a request is repeated; must be below `exchange_deadline_s`",
          "never")};
  using drivers::TcpAddress;
  keys.tcp = {required("host", &TcpAddress::host, {},
                       "numeric IPv4 or IPv6 address of the board; host names are not resolved"),
              required("port", &TcpAddress::port, {1, 65535},
                       "TCP port of the board; the standard port of Modbus TCP is 502")};
  keys.framing = {optional("framing", &TcpAddress::rtu_framing, {"tcp", "rtu"},
                           "`rtu`: the board is connected to a serial server that forwards RTU frames")};
  keys.rtu_framing = {
      optional("silence_s", &TcpAddress::silence_s, {0, 1},
               "only with `framing: rtu`: smallest silence between a response and the next request")};
  keys.numbering = {{"accept_no_transaction_id", "a text", "none",
                     "required for a gateway whose responses do not contain the transaction id of the "
                     "request; the value is a sentence that states the accepted risk"}};
  using drivers::SerialLine;
  keys.serial = {
      required("device", &SerialLine::device, {}, "path of the device, such as `/dev/serial/by-id/...`"),
      required("baud", &SerialLine::baud, {1200, 1'000'000}, "one of the usual baud rates"),
      {"format", "a text", "", "data bits, parity and stop bits: `8N1`, `8E1`, `8O1`, `8N2` or `8E2`"},
      optional("silence_s", &SerialLine::silence_s, {1e-5, 1}, "smallest silence between two frames",
               "3.5 characters"),
      required("turnaround_s", &SerialLine::turnaround_s, {0, 1},
               "response time of a module, without the silence between request and response"),
      optional("adapter_latency_s", &SerialLine::adapter_latency_s, {0, 1},
               "largest delay of a response in the serial adapter", "latency that Linux reports"),
      optional("echo", &SerialLine::echo, {},
               "`true`: the adapter also receives the frames that it has sent")};
}

void declare_converters(RigKeys& keys) {
  using drivers::IioTerminal;
  keys.iio = {optional("root", &drivers::IioSettings::root, {}, "folder in which Linux lists the converters"),
              {"inputs", "list", "", "terminals that the channels use as inputs 0, 1 and so on"},
              {"outputs", "list", "", "terminals that the channels use as outputs 0, 1 and so on"},
              {"heartbeat", "map", "none", "output terminal whose signal changes in every exchange"}};
  keys.iio_terminal = {
      required("device", &IioTerminal::device, {},
               "[word that identifies one converter](#devices-of-the-computer)"),
      required(
          "channel", &IioTerminal::channel, {},
          "channel of the converter, such as `voltage0`, `current1`, `voltage0-voltage1` or `pressure`")};
  keys.iio_output = {required("raw_max", &IioTerminal::raw_max, {1, largest_raw},
                              "only for outputs: largest raw number that the converter accepts")};
  keys.heartbeat = {
      {"raw", "two whole numbers", "", "two raw numbers, which softgripd writes to this output alternately"},
      required(
          "timeout_s", &drivers::IioHeartbeat::timeout_s, {0.001, 3600},
          "time without a change of this output after which the external circuit switches off the valves")};
  keys.seed = {required("seed", &RigFile::seed, document::Range{.lower = 0},
                        "seed of the simulated noise; equal seeds give equal noise")};
  keys.simulated = {required(
      "watchdog_timeout_s", &simulation::SimulatedBoardSettings::watchdog_timeout_s, {0, 60},
      "time without an exchange after which the simulated outputs go to the rest pressure; 0: no watchdog")};
  using simulation::SimulatedChannel;
  keys.converters = {required("output_bits", &SimulatedChannel::output_bits, {0, 24},
                              "resolution of the simulated outputs in bits; 0: no quantisation"),
                     required("input_bits", &SimulatedChannel::input_bits, {0, 24},
                              "resolution of the simulated displacement inputs in bits; 0: no quantisation"),
                     {"plants", "map", "",
                      "map of the simulated fingers: each key is the name of a channel, and its value "
                      "describes the finger of this channel"},
                     {"events", "list", "none", "changes of the simulated rig at given times"}};
  using Plant = simulation::PlantSettings;
  keys.plant = {{"model", "a path", "", "model file of the simulated finger"},
                required("displacement_noise_mm", &Plant::displacement_noise_mm, {0, 100},
                         "standard deviation of the noise of the displacement readings"),
                required("pressure_noise_kpa", &Plant::pressure_noise_kpa, {0, 100},
                         "standard deviation of the noise of the pressure readings"),
                optional("temperature_c", &Plant::temperature_c, {-50, 150},
                         "ambient temperature of the simulated finger"),
                optional("temperature_noise_c", &Plant::temperature_noise_c, {0, 100},
                         "standard deviation of the noise of the temperature readings"),
                {"object", "map", "none",
                 "object in the path of the finger at the start of the simulation; a map with `position_mm` "
                 "and `yielding`"}};
}

}  // namespace

void declare_board_keys(RigKeys& keys) {
  declare_gpio(keys);
  declare_modbus(keys);
  declare_converters(keys);
}

}  // namespace softgrip::rig
