#include "tests/world/motion_world.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers.h"
#include "base/random.h"
#include "tests/world/guest.h"
#include "tests/world/surroundings.h"
#include "tools/commissioning/examinations.h"
#include "tools/commissioning/procedure.h"

namespace softgrip::world {
namespace {

using Kind = Incident::Kind;

/// Pause between the end of one command and the start of the next command.
constexpr Nanoseconds call_pause = ns_per_s;
constexpr double longest_answer_s = 1.5;
/// Largest number of writes of the program that may replace values of another client. The driver reads the
/// outputs before a write in only 1 of 8 exchanges, so this number is larger than 1.
constexpr unsigned most_overwritten = 32;

/// A simulated operator. After a delay, the operator enters the reading of the simulated displacement sensor
/// or pressure sensor.
class PersonInWorld final : public tools::calibrate::Operator {
 public:
  PersonInWorld(Surroundings& around, std::size_t channel, std::uint64_t seed)
      : around_(around), channel_(channel), seed_(seed) {}

  void tell(const std::string& text) override { around_.trace("printed: {}", text); }
  void ask(const std::string& question) override {
    around_.trace("asked: {}", question);
    of_pressure_ = question.starts_with("manometer");
    answers_at_ = around_.scheduler.now() + nanoseconds(longest_answer_s * uniform_at(seed_, ++asked_));
  }
  std::optional<std::string> answer() override {
    const Nanoseconds now = around_.scheduler.now();
    if (now < answers_at_) return std::nullopt;
    around_.hardware.move_to(now);
    simulation::Plant& plant = around_.hardware.plant(channel_);
    return shortest(of_pressure_ ? plant.measured_pressure_kpa() : plant.reading_mm());
  }
  [[nodiscard]] bool gone() const override { return false; }
  [[nodiscard]] bool patient() const override { return false; }

 private:
  Surroundings& around_;
  std::size_t channel_;
  std::uint64_t seed_;
  std::uint64_t asked_ = 0;
  bool of_pressure_ = false;
  Nanoseconds answers_at_ = 0;
};

class MotionWorld {
 public:
  MotionWorld(const Library& library, std::uint64_t seed, const WorldOptions& options)
      : options_(options),
        seed_(derived_seed(seed, 4)),
        around_(shape_for(options.tool, library.rig, seed, options.always_habits), options.trace),
        clock_(around_.scheduler) {
    around_.on_write = [this](Nanoseconds began, std::span<const double> commands) {
      wrote(began, commands);
    };
    around_.on_exchange = [this] {
      // The previous exchange has ended. Until here, `good_` is true if no incident prevented the previous
      // exchange.
      spoke_ = spoke_ || good_;
      good_ = around_.line.status == drivers::BusStatus::ok;
      spoke_since_trip_ = true;
      around_.monitor.exchange_begins();
    };
    around_.on_hindered = [this] { good_ = false; };
    around_.on_trip = [this] { tripped(); };
    result_.shape = around_.shape.text;
    result_.incidents =
        options.incidents
            ? *options.incidents
            : draw_incidents({seed, options.length, around_.shape.watchdog, around_.shape.may_pause_late(),
                              library.sequences.size(), around_.hardware.channels(), false, 1});
  }

  WorldResult run() {
    call();
    around_.let_happen(result_.incidents,
                       [this](const Incident& incident, bool begins) { carry_out(incident, begins); });
    around_.scheduler.add("outside", [this] { outside_body(); });
    around_.scheduler.run_until(around_.begin + options_.length, [](ActorId) {});
    result_.violation = around_.monitor.violation();
    result_.trace = std::move(around_.traced);
    result_.fingerprint = around_.fingerprint;
    result_.writes = around_.writes;
    result_.trips = around_.trips;
    return std::move(result_);
  }

 private:
  [[nodiscard]] double drawn() { return uniform_at(seed_, ++drawn_); }

  /// Calls the command repeatedly until the simulation ends.
  void call() {
    actor_ = around_.scheduler.add("tool", [this] {
      for (;;) {
        begin();
        options_.tool == Tool::doctor ? examine() : calibrate();
        alive_ = false;
        around_.trace("{} has ended", tool_names[static_cast<std::size_t>(options_.tool)]);
        around_.scheduler.sleep_until(around_.scheduler.now() + call_pause);
      }
    });
  }

  void begin() {
    around_.trace("{} begins", tool_names[static_cast<std::size_t>(options_.tool)]);
    ++result_.met.calls;
    alive_ = true;
    interrupted_ = vented_ = up_ = good_ = spoke_ = spoke_since_trip_ = false;
    overwritten_ = 0;
    written_.clear();
    around_.nobody_spoke();
    around_.monitor.boots();
    around_.monitor.may_rise(true);
  }

  /// Returns true if the command must stop. The command calls this function before every exchange.
  [[nodiscard]] bool stops() {
    if (interrupted_) around_.monitor.may_rise(false);
    return interrupted_;
  }

  void calibrate() {
    const rig::RigFile& rig = around_.shape.rig;
    tools::calibrate::Settings settings;
    settings.channel = static_cast<std::size_t>(drawn() * static_cast<double>(around_.hardware.channels()));
    settings.may_move = true;
    tools::calibrate::set_places(settings, rig.settings.channels[settings.channel].limits);
    settings.settle_s = settings.average_s = 0.5;
    settings.ramp_s = 4;
    PersonInWorld person(around_, settings.channel, derived_seed(seed_, result_.met.calls));
    tools::MotionSession session(rig, around_.board, clock_, [this] { return stops(); });
    if (!session.connect()) return;
    const std::string failure = measure(session, person, settings);
    around_.trace("calibrate: {}", failure.empty() ? "a result" : failure);
    judge(failure.empty());
    if (session.leave()) left();
  }

  /// Runs one of the calibration procedures. Returns "" if the procedure has a result. Otherwise returns the
  /// reason why it has no result.
  [[nodiscard]] std::string measure(tools::MotionSession& session, PersonInWorld& person,
                                    const tools::calibrate::Settings& settings) {
    const rig::RigFile& rig = around_.shape.rig;
    const auto why = [](const auto& result) { return result ? std::string() : result.error().text; };
    switch (static_cast<int>(4 * drawn())) {
      case 0:
        return why(tools::calibrate::calibrate_sensor(rig, session, person, settings));
      case 1:
        return why(tools::calibrate::calibrate_valve(rig, session, person, settings, false));
      case 2:
        return why(tools::calibrate::calibrate_valve(rig, session, person, settings, true));
      default:
        return why(tools::calibrate::search_dead_zone(rig, session, person, settings));
    }
  }

  void examine() {
    tools::doctor::Findings findings;
    tools::doctor::examine_rig(
        around_.shape.rig, around_.board, clock_, [this] { return stops(); }, true, {}, findings);
    bool safe = false;
    for (const tools::doctor::Finding& finding : findings.list()) {
      around_.trace("doctor: {} {}: {}", tools::doctor::name_of(finding.verdict), finding.name, finding.text);
      safe = safe || (finding.name == "safe state" && finding.verdict == tools::doctor::Verdict::ok);
    }
    judge(findings.worst() != tools::doctor::Verdict::fail);
    if (safe) left();
  }

  void judge(bool result) {
    result_.met.results += result ? 1U : 0U;
    if (result && vented_ && spoke_since_trip_)
      around_.monitor.told_nobody(around_.scheduler.now(),
                                  "the command reported a result in spite of this event");
    if (result && overwritten_ > most_overwritten)
      around_.monitor.command_breaks(around_.scheduler.now(), "writes of another Modbus client are detected",
                                     "the command ended with a result");
  }

  /// Called when the command has reported that the board confirmed the rest pressures.
  void left() { around_.monitor.left(around_.scheduler.now(), around_.hardware.outputs_kpa()); }

  void tripped() {
    if (!alive_ || !spoke_) return;
    ++result_.met.gaps;
    around_.monitor.tripped(false);
    vented_ = vented_ || up_;
    spoke_since_trip_ = false;
  }

  void wrote(Nanoseconds began, std::span<const double> commands) {
    const auto outputs = around_.hardware.outputs_kpa();
    const std::uint64_t foreign_writes = around_.hardware.foreign_writes;
    const bool foreign = std::exchange(foreign_writes_, foreign_writes) != foreign_writes;
    if (foreign && !written_.empty() && !std::equal(outputs.begin(), outputs.end(), written_.begin()))
      ++overwritten_;
    written_.assign(commands.begin(), commands.end());
    up_ = false;
    for (std::size_t i = 0; i < commands.size(); ++i)
      up_ = up_ || commands[i] != control::resting_kpa(around_.shape.rig.settings.channels[i].limits);
    // The rest pressures may be written in a single step. After a disturbance of the line, any pressure may
    // return towards rest in a single step.
    const bool safe_outputs = !up_ || around_.excuse().no_line;
    around_.monitor.write(began, around_.scheduler.now(), outputs, commands, safe_outputs);
    around_.note_write(outputs, commands);
  }

  void carry_out(const Incident& incident, bool begins) {
    if (Surroundings::concerns(incident.kind)) {
      if (begins) count(incident.kind);
      return around_.carry_out(incident, begins);
    }
    if (!begins || !alive_) return;
    const Nanoseconds until = around_.scheduler.now() + incident.duration;
    // On some boards, any write clears a watchdog trip. With such a board, no program can detect a pause
    // between its reading of the clock and its write.
    const bool may_be_late = around_.shape.may_pause_late();
    switch (incident.kind) {
      case Kind::stop:
      case Kind::terminate:
        interrupted_ = true;
        around_.monitor.asked(control::Request::Kind::vent);
        break;
      case Kind::kill:
        kill();
        break;
      case Kind::pause:
      case Kind::pause_all:
        around_.scheduler.pause(actor_, until);
        break;
      case Kind::pause_late:
        may_be_late ? around_.scheduler.pause_after_look(actor_, incident.duration)
                    : around_.scheduler.pause(actor_, until);
        break;
      default:
        return;
    }
    count(incident.kind);
  }

  void count(Kind kind) {
    if (!alive_) return;
    const bool pauses = kind >= Kind::pause && kind <= Kind::clock_stalls;
    ++(pauses ? result_.met.pauses : result_.met.faults);
  }

  void kill() {
    around_.trace("the command is killed");
    around_.scheduler.kill(actor_);
    around_.board.hang_up();
    alive_ = false;
    again_at_ = around_.scheduler.now() + call_pause;
  }

  void outside_body() {
    for (;;) {
      around_.scheduler.sleep_until(around_.scheduler.now() + ns_per_s / 1000);
      const Nanoseconds now = around_.scheduler.now();
      around_.hardware.move_to(now);
      Excuse excuse = around_.excuse();
      excuse.no_daemon = !alive_;
      excuse.paused = around_.scheduler.clock_stalled() || around_.scheduler.paused(actor_);
      around_.monitor.passed(now, excuse, around_.hardware.outputs_kpa());
      if (around_.monitor.violation()) around_.scheduler.stop();
      if (again_at_ == 0 || now < again_at_) continue;
      again_at_ = 0;
      call();
    }
  }

  const WorldOptions& options_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  WorldResult result_;
  Surroundings around_;
  WorldClock clock_;
  ActorId actor_ = 0;
  bool alive_ = false;             // true: the command is running
  bool interrupted_ = false;       // true: the operator has pressed Ctrl-C
  bool up_ = false;                // true: the last write of the command contained a pressure other than the
                                   // rest pressure
  bool vented_ = false;            // true: the board has vented while the command applied a pressure
  bool good_ = false;              // true: no incident has prevented the present exchange so far
  bool spoke_ = false;             // true: the command has had a successful exchange, so it can detect a gap
  bool spoke_since_trip_ = false;  // true: an exchange has begun since the watchdog trip, so the command can
                                   // detect the trip
  std::vector<double> written_;    // values of the last write of the command that has reached the board
  unsigned overwritten_ = 0;  // number of writes by the command line that replaced values of another client
  std::uint64_t foreign_writes_ = 0;
  Nanoseconds again_at_ = 0;
};

}  // namespace

WorldResult run_motion_world(const Library& library, std::uint64_t seed, const WorldOptions& options) {
  return MotionWorld(library, seed, options).run();
}

}  // namespace softgrip::world
