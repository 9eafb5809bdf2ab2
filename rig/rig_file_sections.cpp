// Reads the maps of a rig file that apply to the whole rig.

#include <array>
#include <charconv>

#include "base/numbers.h"
#include "document/number.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using control::SafeAction;
using document::Node;

SafeAction read_action(MapReader& reader, std::string_view key) {
  return reader.choice(key, {"vent", "hold"}) == 0 ? SafeAction::vent : SafeAction::hold;
}

void read_safe_actions(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "safe_action");
  for (std::size_t phase = 0; phase < control::phase_count; ++phase) {
    const auto name = control::name_of(static_cast<control::Phase>(phase));
    context.rig.settings.safety.safe_action[phase] = read_action(reader, name);
  }
}

std::uint32_t cycles(MapReader& reader, std::string_view key, std::int64_t lower) {
  return static_cast<std::uint32_t>(reader.integer(key, lower, 100'000));
}

/// Reads `overrun_cycles`. The deprecated name of this key is `slipped_cycles`.
std::uint32_t overrun_cycles(MapReader& reader) {
  if (!reader.has("slipped_cycles")) return cycles(reader, "overrun_cycles", 0);
  const std::uint32_t number = cycles(reader, "slipped_cycles", 0);
  if (reader.optional_integer("overrun_cycles", 0, 100'000))
    reader.report("slipped_cycles", "this repeats overrun_cycles", "overrun_cycles alone");
  return number;
}

/// Reads the list of processor numbers.
std::vector<int> read_cpus(Context& context, MapReader& reader) {
  std::vector<int> cpus;
  for (const Node* item : reader.sequence("cpus", true)) {
    const auto number = document::parse_integer(*item);
    if (!number.value) {
      context.problems.add(context.document.problem(item->at, "`cpus` " + number.message, number.hint));
    } else if (*number.value < 0 || *number.value > 1023) {
      context.problems.add(context.document.problem(
          item->at, "`cpus` is " + std::to_string(*number.value) + ", allowed is 0 to 1023"));
    } else {
      cpus.push_back(static_cast<int>(*number.value));
    }
  }
  return cpus;
}

/// Converts permissions in the form that `ls` prints, such as `rw-rw----`. Returns nothing for any other
/// text.
std::optional<unsigned> in_letters(std::string_view text) {
  constexpr std::string_view letters = "rwxrwxrwx";
  if (text.size() != letters.size()) return std::nullopt;
  unsigned mode = 0;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (text[i] != letters[i] && text[i] != '-') return std::nullopt;
    mode = mode << 1U | (text[i] == '-' ? 0U : 1U);
  }
  return mode;
}

/// Converts permissions in the form that `chmod` accepts: three octal digits, with an optional leading 0.
/// Returns nothing for any other text.
std::optional<unsigned> octal(std::string_view text) {
  if (text.size() == 4 && text[0] == '0') text.remove_prefix(1);
  unsigned mode = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), mode, 8);
  if (text.size() != 3 || result.ec != std::errc{} || result.ptr != text.data() + text.size()) {
    return std::nullopt;
  }
  return mode;
}

/// Reads the permissions of a socket. `moves` is true if clients of this socket may move the gripper.
void read_socket_mode(MapReader& reader, SocketFile& socket, bool moves) {
  const std::string text = reader.text("mode");
  if (text.empty()) return;
  const auto letters = in_letters(text);
  const auto mode = letters ? letters : octal(text);
  if (!mode) {
    reader.report("mode",
                  "`mode` must state the permissions of the socket, found `" + document::shown(text) + "`",
                  "write rw-rw----, or \"0660\" in octal: then the owner and the group may connect");
    return;
  }
  socket.mode = *mode;
  if ((*mode & 0111U) != 0) {
    reader.report("mode", "`mode` contains the right to execute, which does not exist for a socket",
                  "write rw-rw----: then the owner and the group may connect");
  }
  if (moves && (*mode & 0006U) != 0) {
    reader.warn("mode", "everyone on this machine may move the gripper",
                "write rw-rw----: then the owner and the group may connect");
  }
}

void read_socket_file(Context& context, MapReader& reader, SocketFile& socket, bool moves) {
  socket.path = resolved(context, reader.text("path"));
  // sockaddr_un has 108 bytes for the path, including the final NUL.
  if (socket.path.size() > 107) {
    reader.report("path",
                  "the path of the socket is longer than 107 bytes, the longest path that Linux permits");
  }
  read_socket_mode(reader, socket, moves);
  socket.group = reader.optional_text("group").value_or("");
}

}  // namespace

void read_safety(Context& context, MapReader& top) {
  const Node* const node = top.child("safety", true);
  if (node == nullptr) return;
  MapReader reader(context.document, *node, context.problems, "safety");
  if (const Node* actions = reader.child("safe_action", true)) read_safe_actions(context, *actions);
  context.rig.settings.safety.on_emergency_stop = read_action(reader, "on_emergency_stop");
  context.rig.loop.max_missed_commands =
      static_cast<std::uint32_t>(reader.integer("max_missed_commands", 1, 1000));
  const auto words = reader.optional_text("accept_no_watchdog");
  context.rig.accept_no_watchdog = words.value_or("");
  if (words && !words->empty() && *words != no_watchdog_words) {
    reader.report(
        "accept_no_watchdog",
        "`accept_no_watchdog` must contain the sentence that states the accepted risk, word by word",
        "accept_no_watchdog: \"" + std::string(no_watchdog_words) + "\"");
  }
}

/// Reads the three keys of the pressure fault. The file must give all three keys or none of them.
void read_pressure_fault(Context& context, MapReader& reader) {
  control::FaultSettings& faults = context.rig.settings.faults;
  const auto wanted = reader.optional_integer("pressure_cycles", 0, 100000);
  const auto tolerance = reader.optional_number("pressure_tolerance_kpa", {0.001, 1000});
  const auto delay = reader.optional_number("pressure_delay_s", {0, 10});
  if (wanted && tolerance && delay) {
    faults.pressure_cycles = static_cast<std::uint32_t>(*wanted);
    faults.pressure_tolerance_kpa = *tolerance;
    faults.pressure_delay_s = *delay;
  } else if (wanted || tolerance || delay) {
    reader.report(wanted      ? "pressure_cycles"
                  : tolerance ? "pressure_tolerance_kpa"
                              : "pressure_delay_s",
                  "give `pressure_cycles`, `pressure_tolerance_kpa` and `pressure_delay_s` together",
                  "give all three keys, or omit all three if the measured pressure shall not be compared "
                  "with the command");
  }
}

void read_faults(Context& context, MapReader& top) {
  const Node* const node = top.child("faults", true);
  if (node == nullptr) return;
  MapReader reader(context.document, *node, context.problems, "faults");
  control::FaultSettings& faults = context.rig.settings.faults;
  faults.bus_down_cycles = cycles(reader, "bus_down_cycles", 1);
  faults.invalid_reading_cycles = cycles(reader, "invalid_reading_cycles", 1);
  faults.displacement_cycles = cycles(reader, "displacement_cycles", 1);
  faults.readback_cycles = cycles(reader, "readback_cycles", 1);
  faults.readback_tolerance_kpa = reader.number("readback_tolerance_kpa", {0.001, 1000});
  faults.readback_delay_s = reader.number("readback_delay_s", {0, 10});
  read_pressure_fault(context, reader);
  faults.overrun_cycles = overrun_cycles(reader);
  faults.model_unfit_is_fault = reader.boolean("model_unfit_is_fault");
  faults.unsteady_is_fault = reader.optional_boolean("unsteady_is_fault").value_or(false);
}

void read_detection(Context& context, MapReader& top) {
  const Node* const node = top.child("detection", true);
  if (node == nullptr) return;
  MapReader reader(context.document, *node, context.problems, "detection");
  control::DetectionSettings& detection = context.rig.settings.detection;
  detection.margin_mm = reader.number("margin_mm", {0.001, 1000});
  const auto rmse = reader.optional_number("model_rmse_mm", {0, 1000});
  if (!rmse) return;
  detection.model_rmse_mm = *rmse;
  if (reader.good("margin_mm") && reader.good("model_rmse_mm") && detection.margin_mm < 3 * *rmse) {
    reader.report("margin_mm", "`margin_mm` must be at least three times `model_rmse_mm`",
                  "at least " + written(3 * *rmse) + ", or identify a better model");
  }
}

void read_rest(Context& context, MapReader& top) {
  const Node* const node = top.child("rest", true);
  if (node == nullptr) return;
  MapReader reader(context.document, *node, context.problems, "rest");
  control::RigSettings& settings = context.rig.settings;
  settings.rest_band_mm = reader.number("band_mm", {0.001, 100});
  settings.rest_time_s = reader.number("time_s", {0.001, 600});
  settings.rest_timeout_s = reader.number("timeout_s", {0.001, 3600});
  if (reader.good("time_s") && reader.good("timeout_s") && settings.rest_timeout_s <= settings.rest_time_s) {
    reader.report("timeout_s", "`timeout_s` must be longer than `time_s`");
  }
}

void read_loop(Context& context, MapReader& top) {
  const Node* const node = top.child("loop", false);
  if (node == nullptr) return;
  MapReader reader(context.document, *node, context.problems, "loop");
  context.rig.loop.bus_offset_fraction = reader.number("bus_offset_fraction", {0.01, 0.99});
}

void read_real_time(Context& context, MapReader& top) {
  const Node* const node = top.child("real_time", true);
  if (node == nullptr) return;
  MapReader reader(context.document, *node, context.problems, "real_time");
  RealTimeSettings& real_time = context.rig.real_time;
  real_time.required = reader.boolean("required");
  real_time.priority = static_cast<int>(reader.integer("priority", 0, 80));
  real_time.lock_memory = reader.boolean("lock_memory");
  real_time.cpus = read_cpus(context, reader);
  const auto latency = reader.optional_integer("cpu_dma_latency_us", 0, 1'000'000);
  real_time.cpu_dma_latency_us = std::nullopt;
  if (latency) real_time.cpu_dma_latency_us = static_cast<int>(*latency);
  if (const auto stack = reader.optional_integer("prefault_stack_bytes", 0, 4 << 20)) {
    real_time.prefault_stack_bytes = static_cast<std::size_t>(*stack);
  }
  if (const auto heap = reader.optional_integer("prefault_heap_bytes", 0, 1 << 30)) {
    real_time.prefault_heap_bytes = static_cast<std::size_t>(*heap);
  }
}

void read_recorder(Context& context, MapReader& top) {
  const Node* const node = top.child("recorder", true);
  if (node == nullptr) return;
  MapReader reader(context.document, *node, context.problems, "recorder");
  RecorderSettings& recorder = context.rig.recorder;
  recorder.mode = static_cast<RecorderSettings::Mode>(reader.choice("mode", {"off", "sequences", "always"}));
  recorder.directory = resolved(context, reader.text("directory"));
  if (const auto ticks = reader.optional_integer("decimation", 1, 10'000)) {
    recorder.decimation = static_cast<std::uint32_t>(*ticks);
  }
  recorder.flush_interval_s = reader.optional_number("flush_interval_s", {0.001, 0.5}).value_or(0.1);
  recorder.sync_interval_s = reader.optional_number("sync_interval_s", {0, 3600}).value_or(5);
  recorder.history_s = reader.optional_number("history_s", {0, 60}).value_or(1);
}

void read_socket(Context& context, MapReader& top) {
  const Node* const node = top.child("socket", true);
  if (node == nullptr) return;
  MapReader reader(context.document, *node, context.problems, "socket");
  SocketSettings& socket = context.rig.socket;
  read_socket_file(context, reader, socket, true);
  if (const Node* const look = reader.child("look", false)) {
    MapReader look_reader(context.document, *look, context.problems, "socket: look");
    read_socket_file(context, look_reader, socket.look, false);
    if (!socket.look.path.empty() && socket.look.path == socket.path) {
      look_reader.report(
          "path", "this path is already the socket of the operators",
          "choose a different path, because the socket determines the commands that a client may send");
    }
  }
  socket.sequence_directory = resolved(context, reader.text("sequence_directory"));
  const auto bound = [&](std::string_view key, std::size_t& value, std::int64_t lower, std::int64_t upper) {
    if (const auto number = reader.optional_integer(key, lower, upper)) {
      value = static_cast<std::size_t>(*number);
    }
  };
  bound("max_clients", socket.max_clients, 1, 1000);
  bound("max_line_bytes", socket.max_line_bytes, 256, 1 << 20);
  bound("max_queue_bytes", socket.max_queue_bytes, 4096, 64 << 20);
}

control::PlausibilitySettings read_plausibility(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "plausibility");
  control::PlausibilitySettings settings;
  settings.max_age_s = reader.number("max_age_s", {1e-4, 60});
  settings.max_speed_mm_per_s = reader.number("max_speed_mm_per_s", {0.001, 1e6});
  settings.jump_margin_mm = reader.number("jump_margin_mm", {0, 1000});
  settings.frozen_after_s = reader.number("frozen_after_s", {0.001, 3600});
  settings.frozen_band_mm = reader.number("frozen_band_mm", {0, 1000});
  settings.frozen_command_kpa = reader.number("frozen_command_kpa", {0.001, 10'000});
  settings.jump_mm = reader.optional_number("jump_mm", {0.001, 1000}).value_or(settings.jump_mm);
  if (const auto jumps = reader.optional_integer("unsteady_jumps", 2, control::most_unsteady_jumps)) {
    settings.unsteady_jumps = static_cast<std::uint32_t>(*jumps);
  }
  if (context.rate_known && reader.good("max_age_s") && settings.max_age_s <= context.period_s()) {
    reader.report("max_age_s",
                  "`max_age_s` must be longer than one cycle of the control loop, which is " +
                      written(context.period_s()) + " s",
                  "otherwise every reading would be too old");
  }
  return settings;
}

control::ModelHealthSettings read_model_health(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "model_health");
  control::ModelHealthSettings settings;
  settings.model_error_mm = reader.number("model_error_mm", {1e-6, 1000});
  settings.correlation_time_s = reader.number("correlation_time_s", {1e-6, 3600});
  settings.noise_mm = reader.number("noise_mm", {1e-6, 1000});
  settings.unfit_mm = reader.number("unfit_mm", {1e-6, 1000});
  const auto refine = [&](std::string_view key, double& value, double upper) {
    value = reader.optional_number(key, {1e-6, upper}).value_or(value);
  };
  refine("interval_s", settings.interval_s, 3600);
  refine("allowance_sigma", settings.allowance_sigma, 100);
  refine("false_alarm_interval_s", settings.false_alarm_interval_s, 1e12);
  refine("unfit_window_s", settings.unfit_window_s, 3600);
  return settings;
}

}  // namespace softgrip::rig
