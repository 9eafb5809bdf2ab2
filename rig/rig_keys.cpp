#include "rig/rig_keys.h"

namespace softgrip::rig {

namespace {

using document::facts_of;
using document::KeyFacts;
using document::Keys;
using document::MapReader;
using document::optional;
using document::required;

/// Range of gauge pressures that a rig file may contain, for any supported finger. The limits of a particular
/// rig are narrower than this range.
const document::Allowed any_pressure_kpa{-100, 2000};
const document::Allowed any_displacement_mm{-1000, 1000};
const document::Allowed cycles{1, 100'000};

void declare_rig(RigKeys& keys) {
  using control::RigSettings;
  keys.rig = {
      {"name", "a name", "", "name of the rig in folders and metrics"},
      required("rate_hz", &RigSettings::rate_hz, {1, 10'000},
               "cycles per second of the control loop and of the bus thread"),
      {"loop", "map", "none", "[time of the exchange with the board in each cycle](#loop)"},
      {"faults", "map", "", "[times after which an error becomes a fault](#faults)"},
      {"board", "map", "",
       "settings of the board: a map with one of the keys `modbus_tcp`, `modbus_rtu`, `iio` and `simulated`"},
      {"plausibility", "map", "none",
       "[limits of a valid reading](#plausibility) for all channels without their own `plausibility`; "
       "required if a channel has none"},
      {"model_health", "map", "none",
       "[expected model residual of a healthy finger](#model_health) for all channels without their own "
       "`model_health`; required if a channel has none"},
      {"channel_defaults", "map", "none", "[keys that apply to all channels](#channel_defaults)"},
      {"channels", "list", "", "1 to 16 [channels](#a-channel)"},
      {"safety", "map", "", "[actions after a stop or a fault](#safety)"},
      {"detection", "map", "", "[detection of a contact](#detection-rest)"},
      {"rest", "map", "", "[detection that the fingers are at rest](#detection-rest)"},
      {"real_time", "map", "", "[requests to the operating system](#real_time)"},
      {"recorder", "map", "", "[recordings](#recorder)"},
      {"socket", "map", "", "[sockets for clients](#socket)"},
      {"gpio", "map", "none",
       "[digital lines: emergency stop, part in position, enable output, lamps](#gpio)"},
  };
  keys.loop = {required(
      "bus_offset_fraction", &LoopSettings::bus_offset_fraction, {0.01, 0.99},
      "time from the start of a cycle to the exchange with the board, as a fraction of the cycle time")};
  using control::DetectionSettings;
  keys.detection = {
      required("margin_mm", &DetectionSettings::margin_mm, {0.001, 1000},
               "contact is detected when the free-motion displacement of the model exceeds the reading by "
               "this distance"),
      optional("model_rmse_mm", &DetectionSettings::model_rmse_mm, {0, 1000},
               "RMSE of the model in free motion; `margin_mm` must be at least 3 times this value", "none")};
  keys.rest = {required("band_mm", &RigSettings::rest_band_mm, {0.001, 100},
                        "a finger is at rest if its readings stay within a band of this width for `time_s`"),
               required("time_s", &RigSettings::rest_time_s, {0.001, 600},
                        "time for which the readings of a finger at rest must stay within `band_mm`"),
               required("timeout_s", &RigSettings::rest_timeout_s, {0.001, 3600},
                        "time after a start at which the start ends with ERROR if a finger is not at rest")};
}

void declare_channel(RigKeys& keys) {
  keys.channel = {
      {"name", "a name", "", "unique name of the channel, for example `left`"},
      {"model", "a path", "", "model file of the finger in free motion, which the controller uses"}};
  keys.channel_parts = {
      {"pid", "map", "", "[settings of the feedback](#pid)"},
      {"limits", "map", "", "[limits of pressure and displacement](#limits)"},
      {"valve", "map", "", "[output terminal and scaling of the valve](#valve)"},
      {"sensor", "map", "", "[input terminal and scaling of the displacement sensor](#sensor)"},
      {"pressure_monitor", "map", "none",
       "input terminal and scaling of the pressure sensor, or of the monitor output of the valve"},
      {"temperature_sensor", "map", "none",
       "input terminal and scaling of the temperature sensor; the daemon records the temperature, but the "
       "controller does not use it"},
      optional("displacement_used", &control::ChannelSettings::displacement_used, {},
               "`false`: the daemon records the displacement readings, but does not use them; requires "
               "`pressure_monitor`"),
      {"plausibility", "map", "map of the rig", "[limits of a valid reading](#plausibility)"},
      {"model_health", "map", "map of the rig",
       "[expected model residual of a healthy finger](#model_health)"},
  };
  using control::FeedforwardSettings;
  keys.feedforward = {
      required("feedforward", &FeedforwardSettings::kind, control::feedforward_names,
               "method with which the feedforward computes the commanded pressure from the model"),
      optional("extra_latency_s", &FeedforwardSettings::extra_latency_s, {0, 1},
               "delay from the computation of a command to the output of the board, in addition to the "
               "delays of the valve blocks in the model",
               "`bus_offset_fraction` of a cycle")};
  using Limits = control::LimitSettings;
  keys.rest_pressure = {optional(
      "rest_kpa", &Limits::rest_kpa, any_pressure_kpa,
      "[pressure of every safe state](#rest_kpa), between `pressure_min_kpa` and `pressure_max_kpa`")};
  keys.limits = {required("pressure_min_kpa", &Limits::pressure_min_kpa, any_pressure_kpa,
                          "smallest permitted commanded pressure"),
                 required("pressure_max_kpa", &Limits::pressure_max_kpa, any_pressure_kpa,
                          "largest permitted commanded pressure"),
                 required("slew_up_kpa_per_s", &Limits::slew_up_kpa_per_s, {0.001, 1e6},
                          "largest rate at which the commanded pressure may increase"),
                 required("slew_down_kpa_per_s", &Limits::slew_down_kpa_per_s, {0.001, 1e6},
                          "largest rate at which the commanded pressure may decrease"),
                 required("displacement_min_mm", &Limits::displacement_min_mm, any_displacement_mm,
                          "smallest displacement that may be commanded"),
                 required("displacement_max_mm", &Limits::displacement_max_mm, any_displacement_mm,
                          "largest displacement that may be commanded"),
                 required("displacement_margin_mm", &Limits::displacement_margin_mm, {0, 1000},
                          "distance beyond the displacement limits at which a reading causes a fault")};
  using Pid = control::PidSettings;
  keys.pid = {
      required("kp_kpa_per_mm", &Pid::kp_kpa_per_mm, {0, 1e6}, "proportional gain"),
      required("ki_kpa_per_mm_s", &Pid::ki_kpa_per_mm_s, {0, 1e6}, "integral gain"),
      required("kd_kpa_s_per_mm", &Pid::kd_kpa_s_per_mm, {0, 1e6}, "derivative gain"),
      required("derivative_filter_s", &Pid::derivative_filter_s, {0, 100},
               "time constant of the derivative filter"),
      required("setpoint_weight", &Pid::setpoint_weight, {0, 1},
               "weight of the reference in the proportional term of the controller"),
      required("anti_windup", &Pid::anti_windup, control::anti_windup_names,
               "method that prevents integrator windup"),
      optional("tracking_time_s", &Pid::tracking_time_s, {1e-4, 1000},
               "time constant of the back-calculation; required with `anti_windup: back_calculation`")};
}

void declare_wiring(RigKeys& keys) {
  keys.output = {
      {"output", "0 to 255", "", "number of the output terminal; each terminal may be used only once"},
      {"module", "a name", "the only module with outputs", "name of the module of this terminal"},
      {"at_v", "two numbers", "",
       "signals at the terminal at the two calibration points; write `at_ma` or `at_kpa` if the unit of the "
       "terminal is mA or kPa"},
      {"is_kpa", "two numbers", "",
       "pressures at the two calibration points; the second pressure may be lower than the first"},
      {"range_kpa", "two numbers", "", "lowest and highest pressure that the valve can control"}};
  keys.input = {
      {"input", "0 to 255", "", "number of the input terminal; each terminal may be used only once"},
      {"module", "a name", "the only module with inputs", "name of the module of this terminal"},
      {"at_v", "two numbers", "",
       "signals at the terminal at the two calibration points; write `at_ma` or `at_kpa` if the unit of the "
       "terminal is mA or kPa"},
      {"is_mm", "two numbers", "",
       "displacements at the two calibration points; the second displacement may be smaller than the first"},
      {"valid_v", "two numbers", "",
       "lowest and highest signal of a valid reading; write `valid_ma` or `valid_kpa` if the unit of the "
       "terminal is mA or kPa"},
      {"error_codes", "list", "none", "signals with which the sensor reports that it cannot measure"}};
  keys.valve = {
      required("on_power_loss", &ValveFacts::on_power_loss, power_loss_names,
               "reaction of the valve to a loss of electrical power: it vents, or it holds the pressure"),
      optional(
          "on_power_loss_kpa", &ValveFacts::power_loss_kpa, line_pressure_kpa,
          "pressure to which a valve with `on_power_loss: vents` goes after a loss of electrical power")};
}

/// Reads `overrun_cycles`, whose deprecated name is `slipped_cycles`.
void read_overrun_cycles(MapReader& reader, const KeyFacts& key, control::FaultSettings& faults) {
  constexpr document::Range any{0, 100'000};
  const std::string_view name = reader.name_in_use(key.name, "slipped_cycles");
  faults.overrun_cycles = static_cast<std::uint32_t>(reader.integer(name, any));
}

void declare_safety(RigKeys& keys) {
  keys.safety = {
      {"safe_action", "map", "",
       "map with the safe action, `vent` or `hold`, of each phase: `idle`, `closing`, `holding` "
       "and `releasing`"},
      required("on_emergency_stop", &control::SafetySettings::on_emergency_stop, control::safe_action_names,
               "action after an emergency stop (F501) or after a loss of the digital inputs (F502)")};
  keys.commands = {
      required(
          "max_missed_commands", &LoopSettings::max_missed_commands, {1, 1000},
          "number of exchanges without a new command after which the bus thread writes the safe outputs"),
      {"accept_no_watchdog", "a text", "none",
       "required if the board has no watchdog that vents: `" + std::string(no_watchdog_words) + "`"}};
  using Fault = control::FaultSettings;
  keys.faults = {
      required("bus_down_cycles", &Fault::bus_down_cycles, cycles,
               "number of consecutive cycles without a successful exchange with the board after which a bus "
               "fault (F1xx) occurs"),
      required(
          "invalid_reading_cycles", &Fault::invalid_reading_cycles, cycles,
          "number of consecutive cycles with an invalid displacement reading after which F201 to F205 occur, "
          "or with an invalid reading of the pressure monitor after which F208 occurs"),
      required("displacement_cycles", &Fault::displacement_cycles, cycles,
               "number of consecutive cycles with a displacement outside its limits after which F206 occurs"),
      required("readback_cycles", &Fault::readback_cycles, cycles,
               "number of consecutive cycles with a read-back output that differs from the commands after "
               "which F301 occurs"),
      required("readback_tolerance_kpa", &Fault::readback_tolerance_kpa, {0.001, 1000},
               "largest permitted distance of the read-back output from the range of the commands of the "
               "last `readback_delay_s`"),
      required("readback_delay_s", &Fault::readback_delay_s, {0, 10},
               "period before each comparison; the read-back output is compared with the lowest and the "
               "highest command of this period"),
      optional("pressure_cycles", &Fault::pressure_cycles, {0, 100'000},
               "number of consecutive cycles with a measured pressure that differs from the commands after "
               "which F207 occurs; 0: no comparison"),
      optional("pressure_tolerance_kpa", &Fault::pressure_tolerance_kpa, {0.001, 1000},
               "largest permitted distance of the measured pressure from the range of the commands of the "
               "last `pressure_delay_s`",
               "none"),
      optional("pressure_delay_s", &Fault::pressure_delay_s, {0, 10},
               "period before each comparison; the measured pressure is compared with the lowest and the "
               "highest command of this period",
               "none"),
      {{"overrun_cycles", "0 to 100000", "",
        "number of consecutive missed cycles of the control loop after which F901 occurs; 0: missed cycles "
        "alone never cause F901"},
       read_overrun_cycles},
      required("model_unfit_is_fault", &Fault::model_unfit_is_fault, {},
               "`true`: a model that does not fit the readings causes the fault F401"),
      optional("unsteady_is_fault", &Fault::unsteady_is_fault, {},
               "`true`: readings that jump back and forth cause the fault F204; `false`: such readings cause "
               "only an event")};
}

void declare_monitoring(RigKeys& keys) {
  using Check = control::PlausibilitySettings;
  keys.plausibility = {
      required("max_age_s", &Check::max_age_s, {1e-4, 60}, "age above which a reading is stale (not valid)"),
      required("max_speed_mm_per_s", &Check::max_speed_mm_per_s, {0.001, 1e6},
               "largest plausible speed of a finger; a faster change of the reading is a jump"),
      required("jump_margin_mm", &Check::jump_margin_mm, {0, 1000},
               "largest change of a reading that noise can cause; it is added to the change that "
               "`max_speed_mm_per_s` permits"),
      required("frozen_after_s", &Check::frozen_after_s, {0.001, 3600},
               "time after which a constant reading is frozen if the command has changed"),
      required("frozen_band_mm", &Check::frozen_band_mm, {0, 1000},
               "largest change of a reading that is regarded as constant"),
      required("frozen_command_kpa", &Check::frozen_command_kpa, {0.001, 10'000},
               "smallest change of the commanded pressure at which a constant reading is regarded as frozen"),
      optional("jump_mm", &Check::jump_mm, {0.001, 1000},
               "size above which the unexplained part of a change between two readings counts as a jump; "
               "motions of up to 1.5 times the motion of the model are explained"),
      optional("unsteady_jumps", &Check::unsteady_jumps, {2, control::most_unsteady_jumps},
               "number of jumps within 1 s, each opposite to the previous jump, at which the sensor is "
               "regarded as unsteady")};
  using Health = control::ModelHealthSettings;
  keys.model_health = {
      required("model_error_mm", &Health::model_error_mm, {1e-6, 1000},
               "standard deviation of the model error"),
      required("correlation_time_s", &Health::correlation_time_s, {1e-6, 3600},
               "correlation time of the model error"),
      required("noise_mm", &Health::noise_mm, {1e-6, 1000}, "standard deviation of the noise of a reading"),
      required("unfit_mm", &Health::unfit_mm, {1e-6, 1000},
               "the model is unfit if the RMS of its residual over `unfit_window_s` exceeds this value"),
      optional("interval_s", &Health::interval_s, {1e-6, 3600},
               "time over which the residual is averaged for each value of the test"),
      optional(
          "allowance_sigma", &Health::allowance_sigma, {1e-6, 100},
          "half of the smallest shift of the residual that the test must detect, in standard deviations"),
      optional("false_alarm_interval_s", &Health::false_alarm_interval_s, {1e-6, 1e12},
               "mean time between two false alarms of a healthy model"),
      optional("unfit_window_s", &Health::unfit_window_s, {1e-6, 3600},
               "time over which the RMS for `unfit_mm` is computed")};
}

void declare_service(RigKeys& keys) {
  using RealTime = RealTimeSettings;
  keys.real_time = {
      required("required", &RealTime::required, {},
               "`true`: softgripd does not start if the operating system does not grant one of the settings "
               "in `real_time`"),
      required("priority", &RealTime::priority, {0, 80},
               "SCHED_FIFO priority of the control loop; 0: default scheduling of Linux"),
      required("lock_memory", &RealTime::lock_memory, {},
               "`true`: softgripd locks its memory in RAM and prefaults it"),
      {"cpus", "list", "",
       "numbers of the processors on which the control loop and the bus thread run; `[]`: all processors"},
      optional("cpu_dma_latency_us", &RealTime::cpu_dma_latency_us, {0, 1'000'000},
               "longest permitted wake-up time of a processor from a sleep state"),
      optional("prefault_stack_bytes", &RealTime::prefault_stack_bytes, {0, 4 << 20},
               "size of the prefaulted stack"),
      optional("prefault_heap_bytes", &RealTime::prefault_heap_bytes, {0, 1 << 30},
               "size of the prefaulted heap")};
  using Recorder = RecorderSettings;
  keys.recorder = {
      required("mode", &Recorder::mode, recorder_mode_names, "periods that the daemon records"),
      required("directory", &Recorder::directory, {}, "folder of the recordings"),
      optional("decimation", &Recorder::decimation, {1, 10'000},
               "number of cycles of the control loop per row of the recording"),
      optional("flush_interval_s", &Recorder::flush_interval_s, {0.001, 0.5},
               "longest period that a recording can lose after `kill -9`"),
      optional("sync_interval_s", &Recorder::sync_interval_s, {0, 3600},
               "longest period that a recording can lose after a power failure; 0: the operating system "
               "decides when it writes to the disk"),
      optional("history_s", &Recorder::history_s, {0, 60},
               "length of the period before the fault that the recording of a fault also contains")};
  keys.look = {
      required("path", &SocketFile::path, {}, "path of the Unix domain socket, at most 107 bytes"),
      {"mode", "a text", "", "permissions of the socket's file, such as `rw-rw----` or `\"0660\"`"},
      optional("group", &SocketFile::group, {}, "group of the socket's file", "group of the daemon")};
  using Socket = SocketSettings;
  const Keys<Socket> own{
      {"read_only", "map", "none", "a second, read-only socket with the keys `path`, `mode` and `group`"},
      required("sequence_directory", &Socket::sequence_directory, {},
               "folder of the sequences that clients can start by their names"),
      optional("max_clients", &Socket::max_clients, {1, 1000},
               "largest number of clients on each of the two sockets"),
      optional("max_line_bytes", &Socket::max_line_bytes, {256, 1 << 20},
               "length of the longest line that a client may send"),
      optional("max_queue_bytes", &Socket::max_queue_bytes, {4096, 64 << 20},
               "largest total size of the responses that wait for one client")};
  keys.socket.assign(keys.look.begin(), keys.look.end());
  keys.socket.insert(keys.socket.end(), own.begin(), own.end());
}

}  // namespace

const RigKeys& rig_keys() {
  static const RigKeys keys = [] {
    RigKeys all;
    for (const auto declare : {declare_rig, declare_channel, declare_wiring, declare_safety,
                               declare_monitoring, declare_service, declare_board_keys})
      declare(all);
    return all;
  }();
  return keys;
}

document::KeyTables rig_tables() {
  const RigKeys& keys = rig_keys();
  return {{"rig", facts_of(keys.rig)},
          {"timing", facts_of(keys.exchange, keys.connecting, keys.budget)},
          {"modbus_tcp",
           facts_of(keys.module, keys.tcp, keys.habits, keys.framing, keys.rtu_framing, keys.numbering)},
          {"modbus_rtu", facts_of(keys.serial, keys.habits, keys.module)},
          {"iio", facts_of(keys.iio)},
          {"terminal", facts_of(keys.iio_terminal, keys.iio_output)},
          {"heartbeat", facts_of(keys.iio_terminal, keys.heartbeat)},
          {"simulated", facts_of(keys.seed, keys.simulated, keys.converters)},
          {"plant", facts_of(keys.plant)},
          {"channel", facts_of(keys.channel, keys.feedforward, keys.rest_pressure, keys.channel_parts)},
          {"pid", facts_of(keys.pid)},
          {"limits", facts_of(keys.limits)},
          {"valve", facts_of(keys.output, keys.valve)},
          {"sensor", facts_of(keys.input)},
          {"safety", facts_of(keys.safety, keys.commands)},
          {"faults", facts_of(keys.faults)},
          {"plausibility", facts_of(keys.plausibility)},
          {"detection", facts_of(keys.detection)},
          {"rest", facts_of(keys.rest)},
          {"model_health", facts_of(keys.model_health)},
          {"loop", facts_of(keys.loop)},
          {"real_time", facts_of(keys.real_time)},
          {"recorder", facts_of(keys.recorder)},
          {"socket", facts_of(keys.socket)},
          {"gpio", facts_of(keys.gpio)},
          {"line", facts_of(keys.gpio_line, keys.gpio_input, keys.gpio_enable)}};
}

}  // namespace softgrip::rig
