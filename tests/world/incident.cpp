#include "tests/world/incident.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "base/random.h"
#include "drivers/board/board.h"
#include "tests/world/daemon_in_world.h"

namespace softgrip::world {
namespace {

using Kind = Incident::Kind;

constexpr std::array<const char*, 31> names{"start",
                                            "start and stop at once",
                                            "stop",
                                            "vent",
                                            "release",
                                            "acknowledge",
                                            "flood",
                                            "terminate",
                                            "kill",
                                            "pause",
                                            "pause late",
                                            "pause all",
                                            "clock stalls",
                                            "line",
                                            "replies lost",
                                            "slow line",
                                            "writes refused",
                                            "other client writes",
                                            "sensor stuck",
                                            "sensor lost",
                                            "line leaks",
                                            "part gone",
                                            "emergency stop",
                                            "disk full",
                                            "plc command",
                                            "plc silent",
                                            "plc cut",
                                            "plc half",
                                            "gateway paused",
                                            "gateway dies",
                                            "daemon dies and plc silent"};
constexpr std::array<const char*, part_count> parts{"loop", "bus", "service", "recorder", "main"};

/// Relative frequency of one kind of incident.
struct Share {
  Kind kind;
  double share;
};
constexpr std::array shares{
    Share{Kind::start, 20},         Share{Kind::interrupted_start, 3}, Share{Kind::stop, 4},
    Share{Kind::vent, 6},           Share{Kind::release, 4},           Share{Kind::acknowledge, 14},
    Share{Kind::flood, 2},          Share{Kind::terminate, 1},         Share{Kind::kill, 1},
    Share{Kind::pause, 10},         Share{Kind::pause_late, 6},        Share{Kind::pause_all, 6},
    Share{Kind::line, 6},           Share{Kind::replies_lost, 3},      Share{Kind::slow_line, 2},
    Share{Kind::write_refused, 2},  Share{Kind::foreign, 2},           Share{Kind::sensor_stuck, 2},
    Share{Kind::sensor_lost, 2},    Share{Kind::line_leaks, 2},        Share{Kind::part_gone, 6},
    Share{Kind::emergency_stop, 3}, Share{Kind::disk_full, 2},
};

constexpr double mean_time_between_stalls_s = 20;

/// Kinds of incidents of softgrip-plc and its masters, with their relative frequencies.
constexpr std::array plc_shares{
    Share{Kind::plc_command, 60},   Share{Kind::plc_silent, 8},     Share{Kind::plc_cut, 14},
    Share{Kind::plc_half, 6},       Share{Kind::gateway_paused, 6}, Share{Kind::gateway_dies, 2},
    Share{Kind::daemon_and_plc, 4},
};
constexpr double mean_time_between_plc_s = 1.2;

class Drawing {
 public:
  explicit Drawing(std::uint64_t seed) : seed_(seed) {}
  double uniform() { return uniform_at(seed_, ++count_); }
  unsigned below(std::size_t n) { return static_cast<unsigned>(uniform() * static_cast<double>(n)); }
  double between(double low, double high) { return low * std::pow(high / low, uniform()); }

 private:
  std::uint64_t seed_;
  std::uint64_t count_ = 0;
};

Kind draw_kind(Drawing& drawing, std::span<const Share> of) {
  double sum = 0;
  for (const Share& one : of) sum += one.share;
  double at = drawing.uniform() * sum;
  for (const Share& one : of) {
    at -= one.share;
    if (at < 0) return one.kind;
  }
  return of.front().kind;
}

/// Draws the duration [s] of a pause, shorter or longer than the watchdog time-out of the board. Half of the
/// drawn pauses are close to this time-out.
double pause_s(Drawing& drawing, Nanoseconds watchdog) {
  const double limit_s = watchdog > 0 ? seconds(watchdog) : 0.5;
  return drawing.uniform() < 0.5 ? limit_s * (0.9 + 0.4 * drawing.uniform()) : drawing.between(0.002, 3);
}

Incident draw_one(Drawing& drawing, const Draw& draw, Nanoseconds at) {
  Incident one;
  one.at = at;
  one.kind = draw_kind(drawing, shares);
  double duration_s = drawing.between(0.01, 4);
  one.target = drawing.below(draw.channels);
  switch (one.kind) {
    case Kind::start:
      one.target = drawing.below(draw.sequences);
      break;
    case Kind::interrupted_start:
      one.target = drawing.below(draw.sequences);
      one.value = drawing.uniform() < 0.5 ? 0 : 1;
      break;
    case Kind::flood:
      one.target = 10 + drawing.below(200);
      break;
    case Kind::pause:
    case Kind::pause_late:
      one.target = drawing.below(part_count - 1);
      if (one.kind == Kind::pause_late && one.target == static_cast<unsigned>(Part::bus) && !draw.late_bus)
        one.target = static_cast<unsigned>(Part::loop);
      duration_s = pause_s(drawing, draw.watchdog);
      break;
    case Kind::pause_all:
      duration_s = pause_s(drawing, draw.watchdog);
      break;
    case Kind::line: {
      constexpr std::array<drivers::BusStatus, 4> ways{
          drivers::BusStatus::disconnected, drivers::BusStatus::timed_out, drivers::BusStatus::bad_reply,
          drivers::BusStatus::exception};
      one.target = static_cast<unsigned>(ways[drawing.below(ways.size())]);
      break;
    }
    case Kind::slow_line:
      one.value = drawing.between(0.002, 0.03);
      break;
    case Kind::foreign:
      one.value = drawing.uniform() < 0.5 ? 0 : 40 * drawing.uniform();
      duration_s = drawing.between(0.005, 1);
      break;
    default:
      break;
  }
  one.duration = nanoseconds(duration_s);
  return one;
}

bool lasts(Kind kind) {
  return kind >= Kind::pause && kind != Kind::plc_command && kind != Kind::gateway_dies;
}

/// Draws stalls of the clock with a separate seed. All other incidents are therefore the same with and
/// without stalls.
void draw_stalls(const Draw& draw, std::vector<Incident>& incidents) {
  Drawing drawing(derived_seed(draw.seed, 3));
  for (double at_s = 1;;) {
    at_s += -draw.calm * mean_time_between_stalls_s * std::log(drawing.uniform());
    const Nanoseconds at = nanoseconds(at_s);
    if (at >= draw.length) return;
    incidents.push_back({at, Kind::clock_stalls, nanoseconds(pause_s(drawing, draw.watchdog)), 0, 0});
  }
}

/// Draws random incidents of softgrip-plc. The PLC clients connect to softgrip-plc in the first second, so no
/// incident begins in this second.
void draw_plc(const Draw& draw, std::vector<Incident>& incidents) {
  Drawing drawing(derived_seed(draw.seed, 5));
  for (double at_s = 1;;) {
    at_s += -mean_time_between_plc_s * std::log(drawing.uniform());
    Incident one{nanoseconds(at_s), draw_kind(drawing, plc_shares), 0, 0, 0};
    if (one.at >= draw.length) return;
    one.target = drawing.uniform() < 0.75 ? 0 : 1;
    if (one.kind == Kind::plc_command) {
      // Command codes of the masters. Most of them are starts; the others are vent, release and acknowledge.
      // The list contains no stop, because a stop must come only from the gateway, when a master becomes
      // silent.
      constexpr std::array codes{1, 1, 1, 3, 4, 5, 5};
      one.value = codes[drawing.below(codes.size())];
    } else {
      one.duration = nanoseconds(drawing.between(0.05, 5));
    }
    incidents.push_back(one);
  }
}

}  // namespace

std::string text_of(const Incident& incident) {
  std::string text =
      fmt::format("{:9.4f} s  {}", seconds(incident.at), names[static_cast<std::size_t>(incident.kind)]);
  switch (incident.kind) {
    case Kind::start:
      text += fmt::format(" sequence {}", incident.target);
      break;
    case Kind::interrupted_start:
      text += fmt::format(" of sequence {}{}", incident.target, incident.value > 0 ? ", by a vent" : "");
      break;
    case Kind::flood:
      text += fmt::format(" of {} acknowledgements", incident.target);
      break;
    case Kind::pause:
    case Kind::pause_late:
      text += fmt::format(" {}", parts[incident.target]);
      break;
    case Kind::line:
      text += fmt::format(" {}", drivers::name_of(static_cast<drivers::BusStatus>(incident.target)));
      break;
    case Kind::slow_line:
      text += fmt::format(" {:.4f} s", incident.value);
      break;
    case Kind::foreign:
      text += fmt::format(" {:.3f} kPa", incident.value);
      break;
    case Kind::sensor_stuck:
    case Kind::sensor_lost:
    case Kind::line_leaks:
      text += fmt::format(" channel {}", incident.target);
      break;
    case Kind::plc_command:
      text += fmt::format(" {} of master {}", incident.value, incident.target);
      break;
    case Kind::plc_silent:
    case Kind::plc_cut:
    case Kind::plc_half:
    case Kind::daemon_and_plc:
      text += fmt::format(" of master {}", incident.target);
      break;
    default:
      break;
  }
  if (lasts(incident.kind)) text += fmt::format(" for {:.4f} s", seconds(incident.duration));
  return text;
}

std::vector<Incident> draw_incidents(const Draw& draw) {
  Drawing drawing(derived_seed(draw.seed, 1));
  // The mean time between incidents is drawn for each simulation. Only with a long mean time, sequences can
  // finish.
  const double mean_pause_s = draw.calm * drawing.between(0.25, 4);
  std::vector<Incident> incidents;
  double at_s = 1 + drawing.uniform();
  incidents.push_back({nanoseconds(at_s), Kind::start, 0, drawing.below(draw.sequences), 0});
  for (;;) {
    at_s += -mean_pause_s * std::log(drawing.uniform());
    const Nanoseconds at = nanoseconds(at_s);
    if (at >= draw.length) break;
    incidents.push_back(draw_one(drawing, draw, at));
    // Before 70 % of the starts, a client sends a request that resets the fault.
    if (incidents.back().kind != Kind::start || drawing.uniform() < 0.3) continue;
    Incident clear;
    clear.at = at - ns_per_s / 10;
    clear.kind = Kind::acknowledge;
    incidents.insert(std::prev(incidents.end()), clear);
  }
  if (draw.late_bus) draw_stalls(draw, incidents);
  if (draw.plc) draw_plc(draw, incidents);
  std::stable_sort(incidents.begin(), incidents.end(),
                   [](const Incident& a, const Incident& b) { return a.at < b.at; });
  return incidents;
}

}  // namespace softgrip::world
