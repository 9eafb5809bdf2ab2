// Reads the maps of a rig file that apply to the whole rig, and the keys that all real boards share.

#include <charconv>

#include "base/numbers.h"
#include "document/node.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using document::Node;

void read_safe_actions(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "safe_action");
  for (const auto& [phase, name] : control::phase_names) {
    context.rig.settings.safety.safe_action[static_cast<std::size_t>(phase)] =
        reader.choice(name, control::safe_action_names);
  }
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

/// Converts permissions from the form that `ls` prints, such as `rw-rw----`. Returns nothing for any other
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

/// Converts permissions from the form that `chmod` accepts: three octal digits, with an optional leading 0.
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

/// Checks the path of a socket, and reads its permissions.
void finish_socket_file(const Context& context, MapReader& reader, SocketFile& socket, bool moves) {
  socket.path = resolved(context, socket.path);
  // The path in sockaddr_un has space for 108 bytes, including the final NUL.
  if (socket.path.size() > 107) {
    reader.report("path",
                  "the path of the socket is longer than 107 bytes, the longest path that Linux permits");
  }
  read_socket_mode(reader, socket, moves);
}

}  // namespace

void read_safety(Context& context, MapReader& top) {
  control::SafetySettings& safety = context.rig.settings.safety;
  read_map(top, "safety", true, rig_keys().safety, safety, [&](MapReader& reader) {
    read_keys(reader, rig_keys().commands, context.rig.loop);
    if (const Node* actions = reader.child("safe_action", true)) read_safe_actions(context, *actions);
    const auto words = reader.optional_text("accept_no_watchdog");
    context.rig.accept_no_watchdog = words.value_or("");
    if (words && !words->empty() && *words != no_watchdog_words) {
      reader.report(
          "accept_no_watchdog",
          "`accept_no_watchdog` must contain the sentence that states the accepted risk, word by word",
          "accept_no_watchdog: \"" + std::string(no_watchdog_words) + "\"");
    }
  });
}

void read_faults(Context& context, MapReader& top) {
  control::FaultSettings& faults = context.rig.settings.faults;
  read_map(top, "faults", true, rig_keys().faults, faults, [&](MapReader& reader) {
    std::vector<const char*> given{"pressure_cycles", "pressure_tolerance_kpa", "pressure_delay_s"};
    std::erase_if(given, [&](const char* key) { return !reader.has(key); });
    if (given.empty() || given.size() == 3) return;
    reader.report(
        given.front(), "give `pressure_cycles`, `pressure_tolerance_kpa` and `pressure_delay_s` together",
        "give all three keys, or omit all three if the measured pressure shall not be compared with "
        "the command");
  });
}

void read_detection(Context& context, MapReader& top) {
  control::DetectionSettings& detection = context.rig.settings.detection;
  read_map(top, "detection", true, rig_keys().detection, detection, [&](MapReader& reader) {
    const double least_mm = 3 * detection.model_rmse_mm;
    if (reader.good("margin_mm") && reader.good("model_rmse_mm") && detection.margin_mm < least_mm) {
      reader.report("margin_mm", "`margin_mm` must be at least three times `model_rmse_mm`",
                    "at least " + written(least_mm) + ", or identify a better model");
    }
  });
}

void read_rest(Context& context, MapReader& top) {
  control::RigSettings& settings = context.rig.settings;
  read_map(top, "rest", true, rig_keys().rest, settings, [&](MapReader& reader) {
    if (reader.good("time_s") && reader.good("timeout_s") && settings.rest_timeout_s <= settings.rest_time_s)
      reader.report("timeout_s", "`timeout_s` must be longer than `time_s`");
  });
}

void read_timing(Context& context, MapReader& reader) {
  RigFile& rig = context.rig;
  read_keys(reader, rig_keys().exchange, rig.loop);
  read_keys(reader, rig_keys().connecting, rig.reconnect);
  read_keys(reader, rig_keys().budget, rig);
  if (reader.good("longest_pause_s") && reader.good("first_pause_s") &&
      rig.reconnect.longest_pause < rig.reconnect.first_pause) {
    reader.report("longest_pause_s", "`longest_pause_s` must not be shorter than `first_pause_s`");
  }
  const double patience_s = rig.settings.faults.bus_down_cycles * context.period_s();
  if (context.rate_known && reader.good("exchange_deadline_s") &&
      rig.loop.exchange_deadline_s >= patience_s) {
    reader.warn("exchange_deadline_s",
                "with these settings, a single exchange that misses its deadline causes the fault bus_down",
                "`bus_down_cycles` correspond to " + written(patience_s) + " s");
  }
}

void read_loop(Context& context, MapReader& top) {
  read_map(top, "loop", false, rig_keys().loop, context.rig.loop);
}

void read_real_time(Context& context, MapReader& top) {
  RealTimeSettings& real_time = context.rig.real_time;
  read_map(top, "real_time", true, rig_keys().real_time, real_time,
           [&](MapReader& reader) { real_time.cpus = read_cpus(context, reader); });
}

void read_recorder(Context& context, MapReader& top) {
  RecorderSettings& recorder = context.rig.recorder;
  read_map(top, "recorder", true, rig_keys().recorder, recorder);
  recorder.directory = resolved(context, recorder.directory);
}

void read_socket(Context& context, MapReader& top) {
  SocketSettings& socket = context.rig.socket;
  read_map(top, "socket", true, rig_keys().socket, socket, [&](MapReader& reader) {
    finish_socket_file(context, reader, socket, true);
    socket.sequence_directory = resolved(context, socket.sequence_directory);
    read_map(
        reader, std::string(reader.name_in_use("read_only", "look")), false, rig_keys().look, socket.look,
        [&](MapReader& look) {
          finish_socket_file(context, look, socket.look, false);
          if (!socket.look.path.empty() && socket.look.path == socket.path) {
            look.report(
                "path", "this path is already the socket of the operators",
                "choose a different path, because each of the two sockets permits different commands");
          }
        },
        "socket: read_only");
  });
}

}  // namespace softgrip::rig
