#include "tests/world/world.h"

#include <dirent.h>
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/files.h"
#include "tests/world/daemon_in_world.h"
#include "tests/world/guest.h"
#include "tests/world/motion_world.h"
#include "tests/world/recordings.h"
#include "tests/world/surroundings.h"

namespace softgrip::world {
namespace {

using Kind = Incident::Kind;
using control::Request;

/// Pause between the end of a daemon and the start of the next daemon.
constexpr Nanoseconds restart_pause = ns_per_s;
constexpr Nanoseconds longest_answer = 2 * ns_per_s;
/// Longest permitted time from the request to end a guest program until its end.
constexpr Nanoseconds longest_end = 60 * ns_per_s;
/// Longest permitted interval between two ticks of the loop if no incident disturbs the loop.
constexpr Nanoseconds longest_tick_gap = ns_per_s / 20;
constexpr Nanoseconds memory_looked_at_every = ns_per_s;
/// Time from the start of a daemon to the first check of its memory and its descriptors.
constexpr Nanoseconds settling = 5 * ns_per_s;
/// Largest permitted growth of the heap since the first check. The event log and a recording each store up to
/// 10,000 events of 0.5 KiB, from which run.json is written. No other data of the daemon may grow.
constexpr std::size_t allowed_growth_bytes = std::size_t{12} << 20;
/// Largest permitted number of file descriptors in addition to those that are open before the first daemon
/// starts. A recording and the file of a sequence use such descriptors.
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

/// If `full` is true, prevents all files of this process from growing, as on a full disk. If `full` is false,
/// allows files to grow.
void fill_disk(bool full) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = full ? 0 : limit.rlim_max;
  setrlimit(RLIMIT_FSIZE, &limit);
}

class World final : public Host {
 public:
  World(const Library& library, std::uint64_t seed, const WorldOptions& options)
      : library_(library),
        options_(options),
        around_(shape_for(options.tool, library.rig, seed, options.always_habits), options.trace),
        guest_(make_guest(options.tool, *this)) {
    around_.on_write = [this](Nanoseconds began, std::span<const double> commands) {
      wrote(began, commands);
    };
    around_.on_exchange = [this] { monitor_.exchange_begins(scheduler_.now(), daemon_->bus_clock.woke()); };
    around_.on_trip = [this] { tripped(); };
    result_.shape = around_.shape.text;
    result_.incidents =
        options.incidents
            ? *options.incidents
            : draw_incidents({seed, options.length, around_.shape.watchdog, around_.shape.may_pause_late(),
                              library.sequences.size(), around_.shape.rig.settings.channels.size(),
                              options.tool == Tool::plc, guest_ ? guest_->calm() : 1});
  }

  WorldResult run() {
    const std::size_t descriptors = descriptors_ = open_descriptors();
    if (guest_) guest_->begin();
    if (managed()) boot({});
    around_.let_happen(result_.incidents,
                       [this](const Incident& incident, bool begins) { carry_out(incident, begins); });
    scheduler_.add("outside", [this] { outside_body(); });
    run_until(around_.begin + options_.length);
    if (guest_) end_guest();
    fill_disk(false);
    bury();
    if (guest_) result_.met = guest_->met();
    guest_.reset();
    if (open_descriptors() != descriptors)
      monitor_.leaks(fmt::format("the process has {} more open descriptors than at the start of the world",
                                 static_cast<long>(open_descriptors()) - static_cast<long>(descriptors)));
    result_.violation = monitor_.violation();
    result_.trace = std::move(around_.traced);
    result_.fingerprint = around_.fingerprint;
    result_.writes = around_.writes;
    result_.trips = around_.trips;
    return std::move(result_);
  }

  // The functions below implement the interface Host for guest programs.
  [[nodiscard]] const Library& library() const override { return library_; }
  [[nodiscard]] Surroundings& around() override { return around_; }
  [[nodiscard]] DaemonInWorld* daemon() override { return daemon_.get(); }
  [[nodiscard]] const std::optional<daemon::Outcome>& outcome() const override { return outcome_; }
  [[nodiscard]] bool vented_in_motion() const override { return vented_in_motion_; }
  void boot(Life life) override {
    trace("softgripd starts");
    monitor_.boots();
    around_.nobody_spoke();
    booted_at_ = memory_looked_at_ = scheduler_.now();
    settled_bytes_ = 0;
    outcome_.reset();
    vented_in_motion_ = false;
    alone_ = life.record_folder.empty();
    if (options_.record) life.folder = fmt::format("{}/{}", folder_.path(), ++lives_);
    rig::RigFile rig = around_.shape.rig;
    rig.recorder.mode =
        options_.record ? rig::RecorderSettings::Mode::sequences : rig::RecorderSettings::Mode::off;
    if (guest_) guest_->prepare(life);
    daemon_ = std::make_unique<DaemonInWorld>(rig, scheduler_, around_.board, std::move(life));
    daemon_->on_submit = [this](Request::Kind kind, std::uint32_t id) { monitor_.submitted(kind, id); };
    if (guest_) guest_->boots(*daemon_);
    recorded_.clear();
    ticked_ = 0;  // reset, because a daemon that died at its first tick must not hide the first tick of the
                  // next one
  }

 private:
  /// Returns true if a service manager starts and restarts the daemon.
  [[nodiscard]] bool managed() const { return !guest_ || !guest_->runs_the_daemon(); }

  void run_until(Nanoseconds end) {
    scheduler_.run_until(end, [this](ActorId id) { after(id); });
  }
  /// Requests the end of the guest program and waits for it, so that no program of this world remains in the
  /// process.
  void end_guest() {
    guest_->end();
    const Nanoseconds give_up = scheduler_.now() + longest_end;
    while (guest_->busy() && !monitor_.violation() && scheduler_.now() < give_up) {
      if (daemon_) daemon_->terminate();
      run_until(scheduler_.now() + ns_per_s / 10);
    }
  }

  template <class... Values>
  void trace(fmt::format_string<Values...> text, Values&&... values) {
    around_.trace(text, std::forward<Values>(values)...);
  }

  void tripped() {
    if (!daemon_) return;
    const bool has_spoken =
        daemon_->bus_statistics.exchanges.value() > daemon_->bus_statistics.failures.value();
    monitor_.tripped(has_spoken);
    if (guest_) ++guest_->met().gaps;
    const bool runs = daemon_->controller.output().state == control::State::running;
    vented_in_motion_ = vented_in_motion_ || runs;
  }

  /// Called after the end of a daemon. Checks the recordings of this daemon and then removes them.
  void bury() {
    if (!daemon_) return;
    around_.board.hang_up();
    const bool whole = daemon_->ended() && !killed_ && alone_;
    const std::string folder = daemon_->rig.recorder.directory;
    const daemon::RecorderStatus status = daemon_->recorder.status();
    buried_.push_back(std::move(daemon_));
    if (options_.record && whole && status.dropped_rows == 0 && !disk_was_full_) {
      const RecordingsRead read =
          check_recordings(folder, recorded_, around_.shape.rig.settings.channels.size());
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

  /// Called once per millisecond. Checks time limits. Detects the end of a daemon and restarts the daemon.
  void outside_body() {
    for (;;) {
      scheduler_.sleep_until(scheduler_.now() + ns_per_s / 1000);
      const Nanoseconds now = scheduler_.now();
      hardware_.move_to(now);
      Excuse excuse = around_.excuse();
      excuse.no_daemon = daemon_ == nullptr;
      excuse.paused = daemon_ && is_paused();
      monitor_.passed(now, excuse, hardware_.outputs_kpa());
      if (guest_) guest_->look(excuse);
      if (monitor_.violation()) {
        scheduler_.stop();
      } else if (!daemon_) {
        if (managed() && now >= boots_at_) boot({});
      } else if (managed() && daemon_->starved()) {
        die("is killed by its service manager");
      } else if (daemon_->ended()) {
        trace("softgripd has ended");
        if (daemon_->safe_state_confirmed()) monitor_.left(now, hardware_.outputs_kpa());
        outcome_ = daemon_->outcome();
        bury();
        boots_at_ = now + restart_pause;
      } else {
        if (managed()) look_at_memory(now);
        for (const auto& [id, asked] : daemon_->unanswered()) {
          // A daemon closes the connection without a response while it ends.
          if (!is_paused() && !daemon_->shared.shutdown_requested.load() &&
              now - std::max(asked.at, undisturbed_since_) > longest_answer)
            monitor_.answer_is_late(now, asked.at);
        }
      }
    }
  }

  /// Once per second, checks the growth of the heap and the number of descriptors of the running daemon. The
  /// checks begin 5 s after the start of the daemon.
  void look_at_memory(Nanoseconds now) {
    const bool due = now - memory_looked_at_ >= memory_looked_at_every && now - booted_at_ >= settling;
    if (!due || options_.trace) return;
    memory_looked_at_ = now;
    // Subtract the list of ticks, because it belongs to the simulation. If a trace is recorded, the growth is
    // not checked.
    const std::size_t bytes = allocated_bytes() - recorded_.capacity() * sizeof(Nanoseconds);
    if (settled_bytes_ == 0) settled_bytes_ = bytes;
    const std::size_t growth = bytes > settled_bytes_ ? bytes - settled_bytes_ : 0;
    result_.growth_bytes = std::max<std::uint64_t>(result_.growth_bytes, growth);
    if (growth > allowed_growth_bytes)
      monitor_.leaks(fmt::format("the heap has grown by {} KiB since {} s after the start of the daemon",
                                 growth >> 10, settling / ns_per_s));
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

  void carry_out(const Incident& incident, bool begins);
  void to_daemon(const Incident& incident);
  void pause(const Incident& incident);
  void count(const Incident& incident);

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
                         std::get<control::GripAnswer>(event.detail).result == control::GripResult::holding;
    result_.holdings += holding ? 1U : 0U;
    if (!options_.trace) return;
    const daemon::EventEntry entry = daemon::describe(event, daemon_->provenance.channel_names, nullptr);
    trace("{} {} {}", entry.kind, entry.channel, entry.text);
  }

  void wrote(Nanoseconds began, std::span<const double> commands) {
    const Nanoseconds now = scheduler_.now();
    const auto outputs = hardware_.outputs_kpa();
    // The slew limit towards the rest pressure does not apply to safe outputs, while the daemon ends, during
    // a stall of the loop and the 0.2 s after it, and after a failed exchange.
    const std::uint64_t failures = daemon_->bus_statistics.failures.value();
    const bool unconfirmed = std::exchange(failures_, failures) != failures;
    const bool safe_outputs = unconfirmed || daemon_->shared.shutdown_requested.load() ||
                              now - last_tick_ > longest_tick_gap ||
                              now - last_tick_gap_end_ < ns_per_s / 5 ||
                              std::equal(commands.begin(), commands.end(), monitor_.safe_kpa().begin());
    monitor_.write(began, now, outputs, commands, safe_outputs);
    around_.note_write(outputs, commands);
  }

  const Library& library_;
  const WorldOptions& options_;
  WorldResult result_;
  ScratchFolder folder_;
  Surroundings around_;
  Scheduler& scheduler_ = around_.scheduler;
  Hardware& hardware_ = around_.hardware;
  Monitor& monitor_ = around_.monitor;
  std::unique_ptr<Guest> guest_;
  std::unique_ptr<DaemonInWorld> daemon_;
  std::vector<std::unique_ptr<DaemonInWorld>> buried_;
  std::vector<Nanoseconds> recorded_;  // times of the ticks of the loop, relative to the origin of the
                                       // daemon's clock
  unsigned lives_ = 0;
  std::optional<daemon::Outcome> outcome_;  // outcome of the last daemon run; nullopt: the daemon was killed
  bool vented_in_motion_ = false;
  bool alone_ = true;  // true: the daemon stores its recordings in the folder of the rig file
  bool killed_ = false;
  bool disk_full_ = false;
  bool disk_was_full_ = false;
  std::size_t descriptors_ = 0;  // number of open descriptors before the first daemon started
  std::size_t settled_bytes_ = 0;
  Nanoseconds booted_at_ = 0;
  Nanoseconds memory_looked_at_ = 0;
  std::uint64_t ticked_ = 0;
  std::uint64_t failures_ = 0;  // number of failed exchanges up to the last write of the daemon
  Nanoseconds boots_at_ = 0;
  Nanoseconds last_tick_ = 0;
  Nanoseconds last_tick_gap_end_ = 0;
  Nanoseconds undisturbed_since_ = 0;
};

void World::carry_out(const Incident& incident, bool begins) {
  if (guest_ && begins) count(incident);
  if (incident.kind > Kind::disk_full) {
    if (incident.kind == Kind::daemon_and_plc && begins && daemon_) die("is killed");
    guest_->carry_out(incident, begins);
  } else if (Surroundings::concerns(incident.kind)) {
    around_.carry_out(incident, begins);
  } else if (incident.kind == Kind::disk_full) {
    disk_full_ = begins;
    disk_was_full_ = true;
    fill_disk(begins);
  } else if (incident.kind == Kind::emergency_stop) {
    if (daemon_) daemon_->shared.inputs.emergency_stop.store(begins);
  } else if (begins && daemon_ && incident.kind > Kind::kill) {
    pause(incident);
  } else if (begins && daemon_ && (incident.kind >= Kind::terminate || !guest_ || guest_->listens())) {
    to_daemon(incident);
  }
}

/// Counts the pauses and faults that occur while a guest program and its daemon run.
void World::count(const Incident& incident) {
  if (!daemon_) return;
  Met& met = guest_->met();
  const bool pauses = (incident.kind >= Kind::pause && incident.kind <= Kind::clock_stalls) ||
                      incident.kind == Kind::gateway_paused;
  const bool hinders = !pauses && incident.kind != Kind::plc_command &&
                       (incident.kind >= Kind::line || incident.kind == Kind::kill);
  met.pauses += pauses ? 1U : 0U;
  met.faults += hinders ? 1U : 0U;
}

void World::to_daemon(const Incident& incident) {
  const auto ask = [this](Request::Kind kind,
                          std::shared_ptr<const daemon::LoadedSequence> sequence = nullptr) {
    daemon_->ask(kind, std::move(sequence));
    if (guest_) guest_->asked(kind);
    monitor_.asked(kind);
  };
  switch (incident.kind) {
    case Kind::start:
      ask(Request::Kind::start, library_.sequences[incident.target % library_.sequences.size()]);
      break;
    case Kind::interrupted_start:
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

/// Returns the rig and the sequences for a seed. Experiments begin and end at 0 kPa, so their rig must have a
/// rest pressure of 0 kPa.
const Library& library_for(const Library& library, std::uint64_t seed, Tool tool) {
  const Library& drawn = library.of(seed);
  const bool experiments = tool == Tool::baseline || tool == Tool::experiment;
  const control::LimitSettings& limits = drawn.rig.settings.channels.front().limits;
  return experiments && control::resting_kpa(limits) != 0 ? library.others.front() : drawn;
}

}  // namespace

WorldResult run_world(const Library& library, std::uint64_t seed, const WorldOptions& options) {
  const bool by_hand = options.tool == Tool::calibrate || options.tool == Tool::doctor;
  const Library& drawn = library_for(library, seed, options.tool);
  return by_hand ? run_motion_world(drawn, seed, options) : World(drawn, seed, options).run();
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
  // Remove half of the incidents, then a quarter, and so on down to single incidents. Keep each removal after
  // which the violation still occurs.
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
