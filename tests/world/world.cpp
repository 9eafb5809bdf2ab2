#include "tests/world/world.h"

#include <dirent.h>
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "base/random.h"
#include "tests/daemon/temporary_folder.h"
#include "tests/world/daemon_in_world.h"
#include "tests/world/hardware.h"
#include "tests/world/recordings.h"
#include "tests/world/rig_shape.h"

namespace softgrip::world {
namespace {

using Kind = Incident::Kind;
using control::Request;

/// Between the end of a daemon and the next one.
constexpr Nanoseconds restart_pause = ns_per_s;
constexpr Nanoseconds longest_answer = 2 * ns_per_s;
/// Of a loop that ticks as it should.
constexpr Nanoseconds longest_tick_gap = ns_per_s / 20;
constexpr Nanoseconds foreign_period = ns_per_s * 7 / 1000;
constexpr Nanoseconds memory_looked_at_every = ns_per_s;
/// When a daemon has what it needs.
constexpr Nanoseconds settling = 5 * ns_per_s;
/// The event log and a recording each keep ten thousand events of half a KiB, and run.json is made of them:
/// the one thing that may grow.
constexpr std::size_t allowed_growth_bytes = std::size_t{12} << 20;
/// A recording and the file of a sequence.
constexpr std::size_t allowed_descriptors = 8;

std::size_t open_descriptors() {
  std::size_t count = 0;
  DIR* const folder = opendir("/proc/self/fd");
  while (readdir(folder) != nullptr) ++count;
  closedir(folder);
  return count;
}

std::size_t allocated_bytes() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

/// While it is true, no file of this process grows: as on a full disk.
void fill_disk(bool full) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = full ? 0 : limit.rlim_max;
  setrlimit(RLIMIT_FSIZE, &limit);
}

/// The beginning or the end of an incident.
struct Act {
  Nanoseconds at = 0;
  const Incident* incident = nullptr;
  bool begins = true;
};

class World {
 public:
  World(const Library& library, std::uint64_t seed, const WorldOptions& options)
      : library_(library),
        options_(options),
        shape_(draw_shape(library.rig, seed)),
        scheduler_(derived_seed(seed, 2), ns_per_s),
        begin_(scheduler_.now()),
        hardware_(hardware_settings()),
        board_(
            hardware_, line_, scheduler_,
            [this](Nanoseconds began, std::span<const double> commands) { wrote(began, commands); },
            [this] { monitor_.exchange_begins(); }),
        monitor_(shape_.rig.settings, shape_.watchdog) {
    result_.shape = shape_.text;
    result_.incidents = options.incidents
                            ? *options.incidents
                            : draw_incidents({seed, options.length, shape_.watchdog,
                                              shape_.trip_latches || shape_.watchdog == 0,
                                              library.sequences.size(), shape_.rig.settings.channels.size()});
    for (const Incident& incident : result_.incidents) {
      acts_.push_back({incident.at, &incident, true});
      if (incident.duration > 0) acts_.push_back({incident.at + incident.duration, &incident, false});
    }
    std::stable_sort(acts_.begin(), acts_.end(), [](const Act& a, const Act& b) { return a.at < b.at; });
  }

  WorldResult run() {
    const std::size_t descriptors = descriptors_ = open_descriptors();
    boot();
    scheduler_.add("incidents", [this] { incidents_body(); });
    scheduler_.add("outside", [this] { outside_body(); });
    scheduler_.run_until(begin_ + options_.length, [this](ActorId id) { after(id); });
    fill_disk(false);
    bury();
    if (open_descriptors() != descriptors)
      monitor_.leaks(fmt::format("{} descriptors more than at first",
                                 static_cast<long>(open_descriptors()) - static_cast<long>(descriptors)));
    result_.violation = monitor_.violation();
    return std::move(result_);
  }

 private:
  HardwareSettings hardware_settings() {
    HardwareSettings settings;
    const auto& simulated = std::get<simulation::SimulatedBoardSettings>(shape_.rig.board);
    for (const simulation::SimulatedChannel& channel : simulated.channels) {
      settings.plants.push_back(channel.plant);
      settings.plants.back().sample_time_s = 0.005;
      settings.plants.back().seed = derived_seed(channel.plant.seed, shape_.seed);
    }
    settings.plant_step = ns_per_s / 200;
    settings.watchdog = shape_.watchdog;
    settings.trip_latches = shape_.trip_latches;
    settings.on_trip = [this] {
      ++result_.trips;
      trace("the board's watchdog vents");
      if (!daemon_) return;
      const bool has_spoken =
          daemon_->bus_statistics.exchanges.value() > daemon_->bus_statistics.failures.value();
      monitor_.tripped(has_spoken);
    };
    return settings;
  }

  template <class... Values>
  void trace(fmt::format_string<Values...> text, Values&&... values) {
    if (!options_.trace) return;
    result_.trace.push_back(fmt::format("{:9.4f} s  ", seconds(scheduler_.now() - begin_)) +
                            fmt::format(text, std::forward<Values>(values)...));
  }

  void boot() {
    trace("softgripd starts");
    monitor_.boots();
    good_since_ = false;
    booted_at_ = memory_looked_at_ = scheduler_.now();
    settled_bytes_ = 0;
    std::string folder = options_.record ? fmt::format("{}/{}", folder_.path(), ++lives_) : std::string();
    rig::RigFile rig = shape_.rig;
    rig.recorder.mode =
        options_.record ? rig::RecorderSettings::Mode::sequences : rig::RecorderSettings::Mode::off;
    daemon_ = std::make_unique<DaemonInWorld>(rig, scheduler_, board_, folder);
    daemon_->on_submit = [this](Request::Kind kind, std::uint32_t id) { monitor_.submitted(kind, id); };
    recorded_.clear();
    ticked_ = 0;  // one that died at its first tick does not hide the next one's
  }

  /// What a daemon leaves behind, when it has ended.
  void bury() {
    if (!daemon_) return;
    board_.hang_up();
    const bool whole = daemon_->ended() && !killed_;
    const std::string folder = daemon_->rig.recorder.directory;
    const daemon::RecorderStatus status = daemon_->recorder.status();
    buried_.push_back(std::move(daemon_));
    if (options_.record && whole && status.dropped_rows == 0 && !disk_was_full_) {
      const RecordingsRead read = check_recordings(folder, recorded_, shape_.rig.settings.channels.size());
      result_.rows += read.rows;
      if (!read.lack.empty()) monitor_.recording_lacks(read.lack);
    }
    buried_.clear();
    if (options_.record) std::filesystem::remove_all(folder);
    disk_was_full_ = disk_full_;
  }

  void die(const char* how) {
    trace("softgripd {}", how);
    killed_ = true;
    daemon_->kill();
    bury();
    killed_ = false;
    boots_at_ = scheduler_.now() + restart_pause;
  }

  /// Looks at everything once a millisecond: bounds on time, ends, restarts.
  void outside_body() {
    for (;;) {
      scheduler_.sleep_until(scheduler_.now() + ns_per_s / 1000);
      const Nanoseconds now = scheduler_.now();
      hardware_.move_to(now);
      Excuse excuse;
      excuse.no_daemon = daemon_ == nullptr;
      excuse.paused = daemon_ && is_paused();
      excuse.no_line = line_hindered_ > 0 || !good_since_;
      excuse.line_but_for_foreign = line_hindered_ > (foreign_ != nullptr ? 1 : 0) || !good_since_;
      monitor_.passed(now, excuse, hardware_.outputs_kpa());
      if (monitor_.violation()) {
        scheduler_.stop();
      } else if (!daemon_) {
        if (now >= boots_at_) boot();
      } else if (daemon_->starved()) {
        die("is killed by its service manager");
      } else if (daemon_->ended()) {
        trace("softgripd has ended");
        if (daemon_->left_safely()) monitor_.left(now, hardware_.outputs_kpa());
        bury();
        boots_at_ = now + restart_pause;
      } else {
        look_at_memory(now);
        for (const auto& [id, asked] : daemon_->unanswered()) {
          // Who is asked while it ends hangs up instead.
          if (!is_paused() && !daemon_->wires.leave.load() &&
              now - std::max(asked.at, undisturbed_since_) > longest_answer)
            monitor_.answer_is_late(now, asked.at);
        }
      }
    }
  }

  /// Once a second, while a daemon lives: what it has allocated and opened since it settled.
  void look_at_memory(Nanoseconds now) {
    const bool due = now - memory_looked_at_ >= memory_looked_at_every && now - booted_at_ >= settling;
    if (!due || options_.trace) return;
    memory_looked_at_ = now;
    // What the world keeps of every tick is not the daemon's; neither is a trace.
    const std::size_t bytes = allocated_bytes() - recorded_.capacity() * sizeof(Nanoseconds);
    if (settled_bytes_ == 0) settled_bytes_ = bytes;
    const std::size_t growth = bytes > settled_bytes_ ? bytes - settled_bytes_ : 0;
    result_.growth_bytes = std::max<std::uint64_t>(result_.growth_bytes, growth);
    if (growth > allowed_growth_bytes)
      monitor_.leaks(fmt::format("{} KiB more than {} s after its start", growth >> 10, settling / ns_per_s));
    const std::size_t opened = open_descriptors() - descriptors_;
    result_.descriptors = std::max<std::uint64_t>(result_.descriptors, opened);
    if (opened > allowed_descriptors) monitor_.leaks(fmt::format("{} descriptors", opened));
  }

  bool is_paused() {
    bool any = scheduler_.clock_stalled();
    for (std::size_t i = 0; i < part_count; ++i)
      any = any || scheduler_.paused(daemon_->actor(static_cast<Part>(i)));
    if (any) undisturbed_since_ = scheduler_.now();
    return any;
  }

  void incidents_body() {
    for (const Act& act : acts_) {
      scheduler_.sleep_until(begin_ + act.at);
      carry_out(*act.incident, act.begins);
    }
    for (;;) scheduler_.sleep_until(begin_ + 2 * options_.length);
  }

  void carry_out(const Incident& incident, bool begins);
  void to_daemon(const Incident& incident);
  void pause(const Incident& incident);
  void to_line(const Incident& incident, bool begins);
  void to_fingers(const Incident& incident, bool begins);

  void after(ActorId id) {
    if (!daemon_ || daemon_->actor(Part::loop) != id) return;
    const std::uint64_t ticks = daemon_->loop_statistics.ticks.value();
    if (ticks == 0 || ticks == ticked_) return;
    ticked_ = ticks;
    ++result_.ticks;
    if (scheduler_.now() - last_tick_ > longest_tick_gap) last_tick_gap_end_ = scheduler_.now();
    last_tick_ = scheduler_.now();
    const control::TickOutput& output = daemon_->controller.output();
    monitor_.ticked(scheduler_.shown(), output);
    recorded_.push_back(daemon_->loop_clock.woke() - daemon_->origin);
    for (const control::Event& event : output.events) note(event);
  }

  void note(const control::Event& event) {
    using EventKind = control::Event::Kind;
    result_.faults += event.kind == EventKind::fault_latched ? 1U : 0U;
    result_.sequences += event.kind == EventKind::sequence_started ? 1U : 0U;
    const bool holding = event.kind == EventKind::grip_result &&
                         static_cast<control::GripResult>(event.detail) == control::GripResult::holding;
    result_.holdings += holding ? 1U : 0U;
    if (!options_.trace) return;
    const daemon::EventEntry entry = daemon::describe(event, daemon_->provenance.channel_names, nullptr);
    trace("{} {} {}", entry.kind, entry.channel, entry.text);
  }

  void wrote(Nanoseconds began, std::span<const double> commands) {
    const Nanoseconds now = scheduler_.now();
    const auto outputs = hardware_.outputs_kpa();
    // Without a loop nobody shapes a ramp.
    // Nor where it is not known what stands there: the lower of what may.
    const std::uint64_t failures = daemon_->bus_statistics.failures.value();
    const bool unconfirmed = std::exchange(failures_, failures) != failures;
    const bool safe_outputs = unconfirmed || daemon_->wires.leave.load() ||
                              now - last_tick_ > longest_tick_gap ||
                              now - last_tick_gap_end_ < ns_per_s / 5 ||
                              std::equal(commands.begin(), commands.end(), monitor_.safe_kpa().begin());
    monitor_.write(began, now, outputs, commands, safe_outputs);
    if (options_.trace && !std::equal(commands.begin(), commands.end(), outputs.begin()))
      trace("wrote {:.4f} kPa over {:.4f}", fmt::join(commands, " "), fmt::join(outputs, " "));
    ++result_.writes;
    good_since_ = true;
    for (const double command : commands) {
      result_.fingerprint = scattered(result_.fingerprint ^ std::bit_cast<std::uint64_t>(command));
    }
    result_.fingerprint = scattered(result_.fingerprint ^ static_cast<std::uint64_t>(now));
  }

  const Library& library_;
  const WorldOptions& options_;
  RigShape shape_;
  WorldResult result_;
  daemon::testing::TemporaryFolder folder_;
  Scheduler scheduler_;
  Nanoseconds begin_;
  Line line_;
  Hardware hardware_;
  WorldBoard board_;
  Monitor monitor_;
  std::vector<Act> acts_;
  std::unique_ptr<DaemonInWorld> daemon_;
  std::vector<std::unique_ptr<DaemonInWorld>> buried_;
  std::vector<Nanoseconds> recorded_;  // when it ticked, since its origin
  unsigned lives_ = 0;
  int line_hindered_ = 0;
  bool good_since_ = false;
  bool killed_ = false;
  bool disk_full_ = false;
  bool disk_was_full_ = false;
  std::size_t descriptors_ = 0;  // before the first daemon
  std::size_t settled_bytes_ = 0;
  Nanoseconds booted_at_ = 0;
  Nanoseconds memory_looked_at_ = 0;
  std::uint64_t ticked_ = 0;
  std::uint64_t failures_ = 0;  // of the bus, when it wrote last
  Nanoseconds boots_at_ = 0;
  Nanoseconds last_tick_ = 0;
  Nanoseconds last_tick_gap_end_ = 0;
  Nanoseconds undisturbed_since_ = 0;
  const Incident* foreign_ = nullptr;
};

void World::carry_out(const Incident& incident, bool begins) {
  if (begins) trace("** {}", text_of(incident));
  if (begins && incident.kind <= Kind::kill) {
    if (daemon_) to_daemon(incident);
  } else if (incident.kind == Kind::pause || incident.kind == Kind::pause_late ||
             incident.kind == Kind::pause_all) {
    if (begins && daemon_) pause(incident);
  } else if (incident.kind == Kind::clock_stalls) {
    if (begins) scheduler_.stall_clock(incident.duration);
  } else if (incident.kind == Kind::disk_full) {
    disk_full_ = begins;
    disk_was_full_ = true;
    fill_disk(begins);
  } else if (incident.kind >= Kind::line && incident.kind <= Kind::foreign) {
    to_line(incident, begins);
  } else if (incident.kind > Kind::foreign) {
    to_fingers(incident, begins);
  }
}

void World::to_daemon(const Incident& incident) {
  const auto ask = [this](Request::Kind kind,
                          std::shared_ptr<const daemon::LoadedSequence> sequence = nullptr) {
    daemon_->ask(kind, std::move(sequence));
    monitor_.asked(kind);
  };
  switch (incident.kind) {
    case Kind::start:
      ask(Request::Kind::start, library_.sequences[incident.target % library_.sequences.size()]);
      break;
    case Kind::hasty:
      ask(Request::Kind::start, library_.sequences[incident.target % library_.sequences.size()]);
      ask(incident.value > 0 ? Request::Kind::vent : Request::Kind::stop);
      break;
    case Kind::stop:
      ask(Request::Kind::stop);
      break;
    case Kind::vent:
      ask(Request::Kind::vent);
      break;
    case Kind::release:
      ask(Request::Kind::release);
      break;
    case Kind::acknowledge:
      ask(Request::Kind::acknowledge);
      break;
    case Kind::flood:
      for (unsigned i = 0; i < incident.target; ++i) ask(Request::Kind::acknowledge);
      break;
    case Kind::terminate:
      daemon_->terminate();
      break;
    case Kind::kill:
      die("is killed");
      break;
    default:
      break;
  }
}

void World::pause(const Incident& incident) {
  const Nanoseconds until = scheduler_.now() + incident.duration;
  if (incident.kind == Kind::pause_all) {
    for (std::size_t i = 0; i < part_count; ++i)
      scheduler_.pause(daemon_->actor(static_cast<Part>(i)), until);
    return;
  }
  const ActorId actor = daemon_->actor(static_cast<Part>(incident.target));
  if (incident.kind == Kind::pause) {
    scheduler_.pause(actor, until);
  } else {
    scheduler_.pause_after_look(actor, incident.duration);
  }
}

void World::to_line(const Incident& incident, bool begins) {
  line_hindered_ += begins ? 1 : -1;
  if (!begins) good_since_ = false;
  switch (incident.kind) {
    case Kind::line:
      line_.status = begins ? static_cast<drivers::BusStatus>(incident.target) : drivers::BusStatus::ok;
      line_.reply_lost = false;
      break;
    case Kind::replies_lost:
      line_.status = begins ? drivers::BusStatus::timed_out : drivers::BusStatus::ok;
      line_.reply_lost = begins;
      break;
    case Kind::slow_line:
      line_.latency = begins ? nanoseconds(incident.value) : Line{}.latency;
      break;
    case Kind::write_refused:
      hardware_.refuses_writes = begins;
      break;
    case Kind::foreign:
      foreign_ = begins ? &incident : nullptr;
      monitor_.foreign_ended();
      if (begins) {
        scheduler_.add("foreign", [this, &incident] {
          const std::vector<double> outputs(hardware_.channels(), incident.value);
          while (foreign_ == &incident) {
            monitor_.foreign_wrote(outputs);
            hardware_.write(scheduler_.now(), outputs);
            scheduler_.sleep_until(scheduler_.now() + foreign_period);
          }
        });
      }
      break;
    default:
      break;
  }
}

void World::to_fingers(const Incident& incident, bool begins) {
  hardware_.move_to(scheduler_.now());
  const std::size_t channel = incident.target % hardware_.channels();
  using Sensor = simulation::SensorFault;
  using LineFault = simulation::LineFault;
  switch (incident.kind) {
    case Kind::sensor_stuck:
      hardware_.plant(channel).set_fault(Sensor{begins ? Sensor::Kind::stuck : Sensor::Kind::none, 0});
      break;
    case Kind::sensor_lost:
      hardware_.plant(channel).set_fault(Sensor{begins ? Sensor::Kind::out_of_range : Sensor::Kind::none, 0});
      break;
    case Kind::line_leaks:
      hardware_.plant(channel).set_fault(
          LineFault{begins ? LineFault::Kind::leaking : LineFault::Kind::none, 0.4});
      break;
    case Kind::part_gone:
      for (std::size_t i = 0; i < hardware_.channels(); ++i) {
        const auto& simulated = std::get<simulation::SimulatedBoardSettings>(shape_.rig.board);
        hardware_.plant(i).set_object(begins ? std::nullopt : simulated.channels[i].plant.object);
      }
      break;
    case Kind::emergency_stop:
      if (daemon_) daemon_->wires.inputs.emergency_stop.store(begins);
      break;
    default:
      break;
  }
}

}  // namespace

WorldResult run_world(const Library& library, std::uint64_t seed, const WorldOptions& options) {
  return World(library, seed, options).run();
}

std::vector<Incident> shrink(const Library& library, std::uint64_t seed, const WorldResult& failed,
                             const WorldOptions& options) {
  std::vector<Incident> best = failed.incidents;
  const auto still_fails = [&](const std::vector<Incident>& incidents) {
    WorldOptions again = options;
    again.incidents = incidents;
    again.trace = false;
    const WorldResult result = run_world(library, seed, again);
    return result.violation && result.violation->invariant == failed.violation->invariant;
  };
  // Half of them, a quarter ... single ones are left out, as long as that leaves the violation.
  for (std::size_t part = std::max<std::size_t>(best.size() / 2, 1);; part /= 2) {
    for (std::size_t begin = 0; begin < best.size();) {
      std::vector<Incident> fewer = best;
      const auto from = fewer.begin() + static_cast<long>(begin);
      fewer.erase(from, from + static_cast<long>(std::min(part, fewer.size() - begin)));
      if (still_fails(fewer)) {
        best = std::move(fewer);
      } else {
        begin += part;
      }
    }
    if (part <= 1) break;
  }
  return best;
}

}  // namespace softgrip::world
