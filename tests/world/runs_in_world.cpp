#include "tests/world/runs_in_world.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/files.h"
#include "base/random.h"
#include "sysid/diagnosis/experiments/experiment.h"
#include "tools/baseline/commissioning_run.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::world {
namespace {

/// Pause between the end of one command and the start of the next command.
constexpr Nanoseconds run_pause = ns_per_s;
/// Interval between two checks of the running daemon by the command.
constexpr Nanoseconds daemon_look_pause = ns_per_s / 100;

/// A guest program that calls a command repeatedly.
class Caller : public Guest {
 public:
  Caller(Host& host, const char* name) : host_(host), name_(name) {}

  void begin() override {
    host_.around().scheduler.add(name_, [this] {
      Scheduler& scheduler = host_.around().scheduler;
      while (!ending_) {
        calls_ = true;
        ++met().calls;
        host_.around().trace("{} begins", name_);
        const bool result = call();
        met().results += result ? 1U : 0U;
        host_.around().trace("{} has ended{}", name_, result ? " with a result" : "");
        calls_ = false;
        scheduler.sleep_until(scheduler.now() + run_pause);
      }
      for (;;) scheduler.sleep_until(scheduler.now() + run_pause);
    });
  }
  [[nodiscard]] bool runs_the_daemon() const override { return true; }
  void end() override { ending_ = true; }
  [[nodiscard]] bool busy() const override { return calls_; }

 protected:
  /// Runs the command once. Returns true if the command ended with a result.
  virtual bool call() = 0;
  [[nodiscard]] bool ending() const noexcept { return ending_; }

  /// Runs a daemon to its end in the thread of the command. Returns the outcome, or nullopt if the daemon was
  /// killed.
  [[nodiscard]] std::optional<daemon::Outcome> play(Life life) {
    Scheduler& scheduler = host_.around().scheduler;
    host_.boot(std::move(life));
    while (host_.daemon() != nullptr) scheduler.sleep_until(scheduler.now() + daemon_look_pause);
    const std::optional<daemon::Outcome>& outcome = host_.outcome();
    if (outcome) judge(*outcome);
    return outcome;
  }
  Host& host_;

 private:
  void judge(const daemon::Outcome& outcome) {
    const ExitCode code = daemon::exit_code_of(outcome);
    const bool done = outcome.sequence_end == control::SequenceEnd::done;
    const Nanoseconds now = host_.around().scheduler.now();
    host_.around().trace("exit code {}", static_cast<int>(code));
    if (code == ExitCode::done && !done)
      host_.around().monitor.command_breaks(now, "exit code 0 means that the sequence ran to its end",
                                            "the sequence did not end");
    if (code == ExitCode::done && host_.vented_in_motion())
      host_.around().monitor.told_nobody(now, "the command ended with exit code 0");
  }

  const char* name_;
  bool calls_ = false;
  bool ending_ = false;
};

class Run final : public Caller {
 public:
  explicit Run(Host& host) : Caller(host, "softgrip run"), seed_(derived_seed(host.around().shape.seed, 6)) {}
  /// For odd seeds, the command has the option --no-socket, so that no client can connect.
  [[nodiscard]] bool listens() const override { return host_.around().shape.seed % 2 == 0; }
  [[nodiscard]] double calm() const override { return 4; }

 private:
  bool call() override {
    const auto& sequences = host_.library().sequences;
    // About half of the runs play the first sequence. The part for this sequence is present, so that some
    // runs finish.
    const double drawn = std::max(0.0, 2 * uniform_at(seed_, met().calls) - 1);
    Life life;
    life.sequence = sequences[static_cast<std::size_t>(drawn * static_cast<double>(sequences.size()))];
    const auto outcome = play(std::move(life));
    return outcome && daemon::exit_code_of(*outcome) == ExitCode::done;
  }

  std::uint64_t seed_;
};

/// Simulates a command that plays experiments on the rig.
class Experiments : public Caller {
 public:
  using Caller::Caller;
  [[nodiscard]] bool listens() const override { return false; }

 protected:
  [[nodiscard]] tools::ExperimentRig world_rig() {
    const rig::RigFile& file = host_.around().shape.rig;
    tools::ExperimentRig rig = tools::experiment_rig(file, file.settings.channels.front().name).value();
    rig.simulated = false;
    rig.run = [this](const rig::RigFile&,
                     const daemon::DaemonOptions& options) -> tl::expected<daemon::Outcome, std::string> {
      // Do not simulate Ctrl-C between two daemons, because the signal would end the whole simulation
      // process.
      if (ending()) return tl::unexpected(std::string("the world ends"));
      Life life;
      life.sequence = options.sequence;
      life.record_folder = options.record_folder;
      const auto outcome = play(std::move(life));
      if (!outcome) return tl::unexpected(std::string("killed"));
      return *outcome;
    };
    return rig;
  }
};

class Baseline final : public Experiments {
 public:
  explicit Baseline(Host& host) : Experiments(host, "softgrip baseline") {}
  [[nodiscard]] double calm() const override { return 20; }

 private:
  bool call() override {
    tools::CommissioningOptions options;
    options.experiments = {"sharp_steps"};
    options.rest_s = 0;
    options.consent = [](const std::string&) { return true; };
    const auto runs = tools::play_commissioning(world_rig(), options);
    if (!runs) host_.around().trace("baseline: {}", runs.error().why);
    return runs.has_value();
  }
};

class Experiment final : public Experiments {
 public:
  explicit Experiment(Host& host) : Experiments(host, "softgrip investigate") {}
  [[nodiscard]] double calm() const override { return 8; }

 private:
  bool call() override {
    const ScratchFolder folder;
    const tools::ExperimentRig rig = world_rig();
    const std::vector<sysid::Waveform> menu = sysid::experiment_menu(rig.limits(0, 0));
    sysid::NextExperiment experiment;
    experiment.best.emplace();
    experiment.best->waveform = menu[met().calls % menu.size()];
    const auto log =
        tools::rig_player(rig, [](const std::string&) { return true; })(experiment, folder.path());
    if (!log) host_.around().trace("investigate: {}", log.error().why);
    return log.has_value();
  }
};

}  // namespace

std::unique_ptr<Guest> make_run(Host& host) {
  return std::make_unique<Run>(host);
}

std::unique_ptr<Guest> make_baseline(Host& host) {
  return std::make_unique<Baseline>(host);
}

std::unique_ptr<Guest> make_experiment(Host& host) {
  return std::make_unique<Experiment>(host);
}

}  // namespace softgrip::world
