// Tests the digital lines. The first tests use the panel alone. The last tests use a running daemon with a
// simulated board.

#include "daemon/panel/panel.h"
#include "base/files.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "daemon/service/daemon.h"
#include "tests/daemon/rig_under_test.h"
#include "tests/daemon/scripted_lines.h"
#include "tests/daemon/service/softgripd_process.h"

namespace softgrip::daemon::panel_test {
namespace {

using drivers::GpioRole;
using testing::Terminals;

rig::GpioSettings all_lines() {
  rig::GpioSettings gpio;
  gpio.debounce_s = 0.005;
  gpio.stale_after_s = 0.5;
  for (std::size_t i = 0; i < drivers::gpio_role_count; ++i) {
    drivers::GpioLineSettings line;
    line.role = static_cast<GpioRole>(i);
    line.chip = "gpiochip0";
    line.offset = static_cast<std::uint32_t>(i);
    gpio.lines.push_back(line);
    gpio.places.push_back({"rig.yaml", {10 + static_cast<int>(i), 5}, "  a line", "", ""});
  }
  return gpio;
}

bool eventually(const std::function<bool()>& condition, double timeout_s = 5) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// Tests of the panel without a daemon, in virtual time. The test simulates the terminals and the control
/// loop.
class PanelTest : public ::testing::Test {
 protected:
  void make(const rig::GpioSettings& settings) {
    settings_ = settings;
    panel_.emplace(terminals_.lines(), settings_, clock_, shared_, statistics_);
  }
  /// Runs the panel for this duration. If `loop_ticks` is true, the loop ticks during this time.
  void run(double duration_s, bool loop_ticks = true) {
    const Nanoseconds end = clock_.now() + nanoseconds(duration_s);
    while (clock_.now() < end) {
      if (loop_ticks) statistics_.ticks.add();
      panel_->step();
    }
  }
  /// Simulates the start of the daemon. The fault is latched, the emergency stop is released, and an operator
  /// resets the fault.
  void make_ready() {
    shared_.state.store(control::State::faulted);
    run(0.03);
    shared_.state.store(control::State::idle);
    run(0.03);
  }
  [[nodiscard]] bool pressed() const { return shared_.inputs.emergency_stop.load(); }
  [[nodiscard]] bool is_on(GpioRole role) const { return terminals_.level(role); }

  rig::GpioSettings settings_;
  VirtualClock clock_;
  Terminals terminals_{clock_};
  SharedState shared_{16};
  LoopStatistics statistics_;
  std::optional<Panel> panel_;
};

TEST_F(PanelTest, StartsWithStopPressedAndInterlockOpen) {
  make(all_lines());
  EXPECT_TRUE(pressed());
  EXPECT_TRUE(shared_.inputs.interlock_open.load());
}

TEST_F(PanelTest, TheStopIsReleasedOnlyAfterTheFaultIsLatched) {
  make(all_lines());
  run(0.05);
  EXPECT_TRUE(pressed())
      << "the panel reports the released line only after the loop has latched the emergency stop";
  shared_.state.store(control::State::faulted);
  run(0.02);
  EXPECT_FALSE(pressed());
}

TEST_F(PanelTest, MissingInputLinesCountAsReleasedAndClosed) {
  rig::GpioSettings settings = all_lines();
  settings.lines.erase(settings.lines.begin(), settings.lines.begin() + 2);
  make(settings);
  run(0.02);
  EXPECT_FALSE(pressed());
  EXPECT_FALSE(shared_.inputs.interlock_open.load());
}

TEST_F(PanelTest, PressingIsDetectedAfterTheDebounceTime) {
  make(all_lines());
  make_ready();
  ASSERT_FALSE(pressed());
  const Nanoseconds began = clock_.now();
  terminals_.set(GpioRole::emergency_stop, true);
  while (!pressed() && clock_.now() - began < ns_per_s) panel_->step();
  EXPECT_GE(clock_.now() - began, nanoseconds(0.005));
  EXPECT_LT(clock_.now() - began, nanoseconds(0.02));
}

TEST_F(PanelTest, PressingIsDetectedWithoutAnEdgeEvent) {
  make(all_lines());
  make_ready();
  terminals_.set(GpioRole::emergency_stop, true, false);
  run(0.03);
  EXPECT_TRUE(pressed());
}

TEST_F(PanelTest, ThePartInPositionInputClosesTheInterlock) {
  make(all_lines());
  run(0.03);
  EXPECT_TRUE(shared_.inputs.interlock_open.load());
  terminals_.set(GpioRole::part_in_position, true);
  run(0.03);
  EXPECT_FALSE(shared_.inputs.interlock_open.load());
}

TEST_F(PanelTest, EnableAndLampsFollowTheState) {
  make(all_lines());
  run(0.01);
  EXPECT_FALSE(is_on(GpioRole::enable));
  EXPECT_FALSE(is_on(GpioRole::ready_lamp));
  shared_.state.store(control::State::faulted);
  run(0.03);
  EXPECT_TRUE(is_on(GpioRole::fault_lamp));
  shared_.state.store(control::State::starting);
  run(0.02);
  EXPECT_FALSE(is_on(GpioRole::enable)) << "the enable output stays off until the rig is ready";
  EXPECT_FALSE(is_on(GpioRole::fault_lamp));
  shared_.state.store(control::State::idle);
  run(0.02);
  EXPECT_TRUE(is_on(GpioRole::enable));
  EXPECT_TRUE(is_on(GpioRole::ready_lamp));
  EXPECT_TRUE(shared_.enable_on.load());
}

TEST_F(PanelTest, HeldPressureMakesTheActiveLampBlink) {
  make(all_lines());
  make_ready();
  const auto lit = [&](GpioRole role) {
    const std::size_t before = terminals_.written(role).size();
    run(3.5);
    const std::vector<bool> written = terminals_.written(role);
    return std::count(written.begin() + static_cast<std::ptrdiff_t>(before), written.end(), true);
  };
  EXPECT_EQ(lit(GpioRole::ready_lamp), 0) << "the ready lamp must not flash";
  EXPECT_TRUE(is_on(GpioRole::ready_lamp));
  shared_.under_pressure.store(true);
  EXPECT_NEAR(static_cast<double>(lit(GpioRole::ready_lamp)), 3.5, 1);
  EXPECT_FALSE(is_on(GpioRole::fault_lamp)) << "the daemon must report no fault";
  EXPECT_TRUE(is_on(GpioRole::enable)) << "the pressure that holds the part must remain";
  shared_.state.store(control::State::faulted);
  EXPECT_NEAR(static_cast<double>(lit(GpioRole::fault_lamp)), 3.5, 1);
  EXPECT_FALSE(is_on(GpioRole::ready_lamp));
  shared_.under_pressure.store(false);
  run(0.02);
  EXPECT_TRUE(is_on(GpioRole::fault_lamp));
  EXPECT_EQ(lit(GpioRole::fault_lamp), 0) << "the lamp no longer flashes";
}

TEST_F(PanelTest, AStalledLoopTurnsTheFaultLampSteadilyOn) {
  rig::GpioSettings settings = all_lines();
  settings.stale_after_s = 0.05;
  make(settings);
  make_ready();
  shared_.under_pressure.store(true);
  run(0.2, false);
  const std::size_t before = terminals_.written(GpioRole::fault_lamp).size();
  run(1.2, false);
  EXPECT_TRUE(is_on(GpioRole::fault_lamp));
  EXPECT_EQ(terminals_.written(GpioRole::fault_lamp).size(), before);
}

TEST_F(PanelTest, AFaultSwitchesEnableOffOnlyIfConfigured) {
  for (const bool drops : {true, false}) {
    rig::GpioSettings settings = all_lines();
    settings.keeps_enable_on_fault = !drops;
    panel_.reset();
    make(settings);
    make_ready();
    ASSERT_TRUE(is_on(GpioRole::enable));
    shared_.state.store(control::State::faulted);
    run(0.02);
    EXPECT_EQ(is_on(GpioRole::enable), !drops);
    shared_.state.store(control::State::starting);  // simulates that the operator has reset the fault
    run(0.02);
    EXPECT_EQ(is_on(GpioRole::enable), !drops);
  }
}

TEST_F(PanelTest, TheEmergencyStopAlwaysSwitchesEnableOff) {
  rig::GpioSettings settings = all_lines();
  settings.keeps_enable_on_fault = true;
  make(settings);
  make_ready();
  terminals_.set(GpioRole::emergency_stop, true);
  run(0.03);
  EXPECT_FALSE(is_on(GpioRole::enable))
      << "the enable output must not wait for the control loop, which still reports the state idle";
}

TEST_F(PanelTest, AStalledLoopSwitchesEnableOffAndReportsLostInputs) {
  rig::GpioSettings settings = all_lines();
  settings.stale_after_s = 0.05;
  make(settings);
  make_ready();
  ASSERT_TRUE(is_on(GpioRole::enable));
  run(0.1, false);
  EXPECT_FALSE(is_on(GpioRole::enable));
  EXPECT_TRUE(is_on(GpioRole::fault_lamp));
  EXPECT_TRUE(shared_.inputs.lost.load()) << "the control loop must detect a fault when it continues";
  run(0.02);
  EXPECT_TRUE(shared_.inputs.lost.load())
      << "the report of the panel must remain until the control loop has latched the fault";
  shared_.state.store(control::State::faulted);
  run(0.02);
  EXPECT_FALSE(shared_.inputs.lost.load());
}

TEST_F(PanelTest, ALostChipReportsLostInputsAndOpensInterlock) {
  make(all_lines());
  make_ready();
  terminals_.fail();
  run(0.02);
  EXPECT_TRUE(shared_.inputs.lost.load());
  EXPECT_TRUE(shared_.inputs.interlock_open.load());
  EXPECT_FALSE(is_on(GpioRole::enable));
  std::vector<PanelEvent::Kind> kinds;
  for (PanelEvent event; shared_.panel_events.pop(event);) kinds.push_back(event.kind);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), PanelEvent::Kind::gpio_lost), 1);
}

TEST_F(PanelTest, ADroppedEnableOutputStaysOff) {
  make(all_lines());
  make_ready();
  panel_->drop();
  run(0.02);
  EXPECT_FALSE(is_on(GpioRole::enable));
  shared_.state.store(control::State::faulted);
  run(0.02);
  shared_.state.store(control::State::idle);
  run(0.02);
  EXPECT_FALSE(is_on(GpioRole::enable));
  EXPECT_FALSE(is_on(GpioRole::ready_lamp));
}

/// Digital lines that write the level of the enable output into a pipe, one byte per change. The parent
/// process can read the bytes after a crash of the child process.
class PipeLines final : public drivers::GpioLines {
 public:
  explicit PipeLines(int descriptor) : descriptor_(descriptor) {}
  std::optional<std::size_t> wait(Nanoseconds, std::span<drivers::GpioEdge>) noexcept override { return 0; }
  std::optional<bool> read(GpioRole) noexcept override { return false; }
  bool write(GpioRole role, bool active) noexcept override {
    const char byte = active ? '1' : '0';
    return role != GpioRole::enable || ::write(descriptor_, &byte, 1) == 1;
  }
  [[nodiscard]] bool sees_edges() const noexcept override { return true; }

 private:
  int descriptor_;
};

TEST(PanelGuard, ACrashSwitchesEnableOffAndKeepsTheSignal) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGQUIT}) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      const rig::GpioSettings settings = all_lines();
      const MonotonicClock clock;
      SharedState shared(16);
      const LoopStatistics statistics;
      Panel panel(std::make_unique<PipeLines>(pipe[1]), settings, clock, shared, statistics);
      const PanelGuard guard(panel);
      ::raise(signal);
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << signal;
    char byte = 0;
    EXPECT_EQ(::read(pipe[0], &byte, 1), 1);
    EXPECT_EQ(byte, '0');
    ::close(pipe[0]);
    ::close(pipe[1]);
  }
}

/// Tests of a complete daemon. The test controls the digital lines of the daemon and communicates with the
/// daemon over its socket.
class PanelOfDaemon : public ::testing::Test {
 protected:
  /// end() sends SIGTERM to this process. Block SIGTERM in all threads, so that only the daemon receives the
  /// signal.
  PanelOfDaemon() {
    sigset_t term;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &term, &before_);
  }
  void start(const std::function<void(rig::RigFile&)>& change = {}) {
    rig::RigFile rig = testing::example_rig("rig.yaml");
    rig.recorder.mode = rig::RecorderSettings::Mode::off;
    rig.real_time = {};
    rig.real_time.priority = 0;
    rig.real_time.lock_memory = false;
    rig.real_time.cpu_dma_latency_us.reset();
    rig.gpio = all_lines();
    rig.socket.path = folder_.path() + "/socket";
    if (change) change(rig);
    DaemonOptions options;
    options.open_gpio = [this](auto) { return open(); };
    auto daemon = Daemon::create(std::move(rig), std::move(options));
    ASSERT_TRUE(daemon) << daemon.error().text;
    daemon_ = std::move(*daemon);
    thread_ = std::thread([this] { outcome_ = daemon_->run(); });
    client_.emplace(folder_.path() + "/socket");
    ASSERT_TRUE(client_->open());
  }
  ~PanelOfDaemon() override {
    end();
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

  virtual tl::expected<std::unique_ptr<drivers::GpioLines>, drivers::GpioFailure> open() {
    return terminals_.lines();
  }
  void end() {
    if (!thread_.joinable()) return;
    ::kill(::getpid(), SIGTERM);  // all threads block the signal, and the daemon waits for the signal
    thread_.join();
  }
  nlohmann::json status() { return client_->ask({{"command", "status"}})["result"]; }
  bool until_state(const std::string& state) {
    return eventually([&] { return status()["state"] == state; });
  }
  nlohmann::json ask(const std::string& command) { return client_->ask({{"command", command}}); }

  sigset_t before_{};
  ScratchFolder folder_;
  Terminals terminals_;
  std::unique_ptr<Daemon> daemon_;
  Outcome outcome_;
  std::thread thread_;
  std::optional<testing::ApiClient> client_;
};

TEST_F(PanelOfDaemon, StartsFaultedAndMovesOnlyAfterReleaseAndAcknowledgement) {
  terminals_.set(GpioRole::emergency_stop, true);
  terminals_.set(GpioRole::part_in_position, true);
  start();
  ASSERT_TRUE(until_state("faulted"));
  EXPECT_EQ(status()["fault"]["code"], "F501");
  EXPECT_EQ(status()["gpio"]["emergency_stop"], true);
  EXPECT_EQ(ask("acknowledge")["error"]["refusal"]["name"], "cause_persists")
      << "the emergency stop is still pressed";

  terminals_.set(GpioRole::emergency_stop, false);
  ASSERT_TRUE(eventually([&] { return status()["gpio"]["emergency_stop"] == false; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(status()["state"], "faulted") << "releasing the emergency stop resets no fault";
  EXPECT_FALSE(terminals_.level(GpioRole::enable));
  EXPECT_TRUE(terminals_.level(GpioRole::fault_lamp));

  EXPECT_EQ(ask("acknowledge")["ok"], true);
  ASSERT_TRUE(until_state("idle"));
  ASSERT_TRUE(eventually([&] { return terminals_.level(GpioRole::enable); }));
  EXPECT_TRUE(terminals_.level(GpioRole::ready_lamp));

  ASSERT_EQ(client_->ask({{"command", "start"}, {"sequence", "pick_stone"}})["ok"], true);
  ASSERT_TRUE(until_state("running"));
  terminals_.set(GpioRole::emergency_stop, true);
  ASSERT_TRUE(until_state("faulted"));
  EXPECT_EQ(status()["fault"]["code"], "F501");
  ASSERT_TRUE(eventually([&] { return !terminals_.level(GpioRole::enable); }));
  ASSERT_TRUE(eventually([&] { return status()["channels"][0]["command_kpa"] == 0; }));

  terminals_.set(GpioRole::emergency_stop, false);
  ASSERT_TRUE(eventually([&] { return ask("acknowledge")["ok"] == true; }));
  ASSERT_TRUE(until_state("idle")) << "the rig must become idle after the acknowledgement";
  end();
  EXPECT_TRUE(outcome_.safe_state_confirmed);
  EXPECT_FALSE(terminals_.level(GpioRole::enable)) << "the enable output is off after the end of the daemon";
  EXPECT_FALSE(terminals_.level(GpioRole::ready_lamp));
}

TEST_F(PanelOfDaemon, AMissingPartRefusesAStart) {
  start([](rig::RigFile& rig) {
    auto& lines = rig.gpio->lines;
    lines.erase(lines.begin());  // a rig without an emergency stop line starts without a fault
  });
  ASSERT_TRUE(until_state("idle"));
  const auto refused = client_->ask({{"command", "start"}, {"sequence", "pick_stone"}});
  EXPECT_EQ(refused["error"]["refusal"]["name"], "interlock_open");
  terminals_.set(GpioRole::part_in_position, true);
  ASSERT_TRUE(eventually([&] { return status()["gpio"]["part_in_position"] == true; }));
  EXPECT_EQ(client_->ask({{"command", "start"}, {"sequence", "pick_stone"}})["ok"], true);
}

TEST_F(PanelOfDaemon, ALostChipIsAFaultThatCannotBeAcknowledged) {
  start([](rig::RigFile& rig) { rig.gpio->lines.erase(rig.gpio->lines.begin()); });
  ASSERT_TRUE(until_state("idle"));
  terminals_.fail();
  ASSERT_TRUE(until_state("faulted"));
  EXPECT_EQ(status()["fault"]["code"], "F502");
  EXPECT_EQ(ask("acknowledge")["error"]["refusal"]["name"], "cause_persists");
}

TEST(PanelRun, AnUnavailableLineEndsTheStartWithFileAndLine) {
  for (const auto kind : {drivers::GpioFailure::Kind::refused, drivers::GpioFailure::Kind::failed}) {
    rig::RigFile rig = testing::example_rig("rig.yaml");
    rig.gpio = all_lines();
    DaemonOptions options;
    options.listen = false;
    options.open_gpio =
        [kind](auto) -> tl::expected<std::unique_ptr<drivers::GpioLines>, drivers::GpioFailure> {
      return tl::unexpected(drivers::GpioFailure{kind, 2, "no such line", "look at gpioinfo"});
    };
    const auto daemon = Daemon::create(std::move(rig), options);
    ASSERT_TRUE(daemon);
    const Outcome outcome = (*daemon)->run();
    EXPECT_EQ(exit_code_of(outcome),
              kind == drivers::GpioFailure::Kind::refused ? ExitCode::input_refused : ExitCode::io);
    EXPECT_EQ(outcome.message.find("rig.yaml:12:5: no such line"), 0U) << outcome.message;
    EXPECT_NE(outcome.message.find("look at gpioinfo"), std::string::npos);
    EXPECT_EQ(outcome.ticks, 0U);
  }
}

TEST(PanelRun, VirtualTimeRefusesDigitalLines) {
  rig::RigFile rig = testing::example_rig("rig.yaml");
  rig.gpio = all_lines();
  DaemonOptions options;
  options.virtual_time = true;
  options.duration_s = 1;
  const auto daemon = Daemon::create(std::move(rig), options);
  ASSERT_FALSE(daemon);
  EXPECT_NE(daemon.error().text.find("digital lines"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::daemon::panel_test
