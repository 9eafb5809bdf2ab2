#include "daemon/panel/panel.h"

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <utility>

namespace softgrip::daemon {

using control::State;
using drivers::GpioRole;

namespace {

/// Largest number of edges that one read returns. The kernel stores up to 16 edges per line.
constexpr std::size_t edges_at_once = 32;

/// Period of a lamp that blinks while fingers are pressurised: half on, half off [ns].
constexpr Nanoseconds blink_period = ns_per_s;

bool in_dark_half(Nanoseconds now) noexcept {
  return now % blink_period >= blink_period / 2;
}

bool works(State state) noexcept {
  return state != State::starting && state != State::faulted;
}

}  // namespace

Panel::Panel(std::unique_ptr<drivers::GpioLines> lines, const rig::GpioSettings& settings, const Clock& clock,
             SharedState& shared, const LoopStatistics& loop) noexcept
    : lines_(std::move(lines)),
      settings_(settings),
      clock_(clock),
      shared_(shared),
      loop_(loop),
      look_interval_(nanoseconds(settings.look_interval_s)),
      stale_after_(nanoseconds(settings.stale_after_s)) {
  const Nanoseconds debounce = nanoseconds(settings.debounce_s);
  if (settings.has(GpioRole::emergency_stop)) emergency_stop_.emplace(debounce);
  if (settings.has(GpioRole::part_in_position)) part_.emplace(debounce);
  shared.inputs.emergency_stop.store(emergency_stop_.has_value());
  shared.inputs.interlock_open.store(part_.has_value());
  shared.inputs.longest_silence = stale_after_;
  shared.inputs.looked_at.store(clock.now());
  ticked_ = clock.now();
}

Panel::~Panel() {
  drop();
}

void Panel::run() noexcept {
  while (!stopped_.load()) step();
}

TripInput* Panel::input(GpioRole role) noexcept {
  if (role == GpioRole::emergency_stop && emergency_stop_) return &*emergency_stop_;
  if (role == GpioRole::part_in_position && part_) return &*part_;
  return nullptr;
}

Nanoseconds Panel::pause(Nanoseconds now) const noexcept {
  Nanoseconds due = now + look_interval_;
  if (emergency_stop_) due = std::min(due, emergency_stop_->due());
  if (part_) due = std::min(due, part_->due());
  return std::max<Nanoseconds>(due - now, 0);
}

void Panel::step() noexcept {
  if (lost_) {
    clock_.sleep_until(clock_.now() + look_interval_);
  } else {
    read_inputs();
  }
  const Nanoseconds now = clock_.now();
  if (!lost_) publish(now);
  drive(now);
}

void Panel::read_inputs() noexcept {
  std::array<drivers::GpioEdge, edges_at_once> edges;
  const auto count = lines_->wait(pause(clock_.now()), edges);
  if (!count) return lose(clock_.now());
  for (const drivers::GpioEdge& edge : std::span(edges).first(*count)) {
    // The active level of the emergency stop means "pressed", and the active level of the part sensor means
    // "in position".
    if (TripInput* const to = input(edge.role)) {
      to->edge(edge.active == (edge.role == GpioRole::emergency_stop), edge.at);
    }
  }
  for (const GpioRole role : {GpioRole::emergency_stop, GpioRole::part_in_position}) {
    TripInput* const to = input(role);
    if (to == nullptr) continue;
    const std::optional<bool> active = lines_->read(role);
    if (!active) return lose(clock_.now());
    to->level(*active == (role == GpioRole::emergency_stop), clock_.now());
  }
}

void Panel::publish(Nanoseconds now) noexcept {
  const bool faulted = shared_.state.load(std::memory_order_relaxed) == State::faulted;
  latched_ = latched_ || faulted;
  if (emergency_stop_) {
    const bool pressed = emergency_stop_->tripped() || !latched_;
    if (shared_.inputs.emergency_stop.exchange(pressed, std::memory_order_relaxed) != pressed) {
      tell(pressed ? PanelEvent::Kind::emergency_stop_pressed : PanelEvent::Kind::emergency_stop_released,
           now);
    }
  }
  if (part_) {
    const bool open = part_->tripped();
    if (shared_.inputs.interlock_open.exchange(open, std::memory_order_relaxed) != open) {
      tell(open ? PanelEvent::Kind::part_away : PanelEvent::Kind::part_in_position, now);
    }
  }
  if (faulted && !hung_) shared_.inputs.lost.store(false, std::memory_order_relaxed);
  shared_.inputs.looked_at.store(now, std::memory_order_relaxed);
}

void Panel::lose(Nanoseconds now) noexcept {
  lost_ = true;
  shared_.inputs.lost.store(true, std::memory_order_relaxed);
  if (part_) shared_.inputs.interlock_open.store(true, std::memory_order_relaxed);
  tell(PanelEvent::Kind::gpio_lost, now);
}

bool Panel::loop_hangs(Nanoseconds now) noexcept {
  const std::uint64_t ticks = loop_.ticks.value();
  if (ticks != ticks_ || ticks == 0) {
    ticks_ = ticks;
    ticked_ = now;
  }
  const bool leaving = shared_.shutdown_requested.load(std::memory_order_relaxed);
  const bool hangs = !leaving && now - ticked_ > stale_after_;
  if (hangs && !hung_) {
    tell(PanelEvent::Kind::loop_hangs, now);
    // If the stalled loop runs again after this point, it must latch a fault.
    shared_.inputs.lost.store(true, std::memory_order_relaxed);
  }
  hung_ = hangs;
  return hangs;
}

/// Returns true if the enable output must be on. The output is switched on when the rig is ready. After a
/// fault, the rig file determines if the output stays on. An emergency stop, lost inputs and a stalled loop
/// always switch the output off. While the rig is starting, the output does not change.
bool Panel::enable_wanted(State state, bool hangs) const noexcept {
  if (hangs || lost_ || shared_.inputs.emergency_stop.load(std::memory_order_relaxed)) return false;
  if (works(state)) return true;
  const bool on = written_[static_cast<std::size_t>(GpioRole::enable)].value_or(false);
  return on && (state == State::starting || settings_.keeps_enable_on_fault);
}

void Panel::drive(Nanoseconds now) noexcept {
  const State state = shared_.state.load(std::memory_order_relaxed);
  const bool hangs = loop_hangs(now);
  const bool enable = enable_wanted(state, hangs);
  const auto& was = written_[static_cast<std::size_t>(GpioRole::enable)];
  const bool changed = settings_.has(GpioRole::enable) && was.value_or(false) != enable;
  write(GpioRole::enable, enable);
  shared_.enable_on.store(enable && !dropped_.load(), std::memory_order_relaxed);
  if (changed) tell(enable ? PanelEvent::Kind::enable_on : PanelEvent::Kind::enable_off, now);
  const bool broken = hangs || lost_;
  // If the loop has stalled, the state of the fingers is unknown. In this case the fault lamp is on and does
  // not blink.
  const bool dark = !broken && shared_.under_pressure.load(std::memory_order_relaxed) && in_dark_half(now);
  write(GpioRole::ready_lamp, works(state) && !broken && !dark);
  write(GpioRole::fault_lamp, (state == State::faulted || broken) && !dark);
}

void Panel::write(GpioRole role, bool active) noexcept {
  std::optional<bool>& written = written_[static_cast<std::size_t>(role)];
  if (written == active) return;
  const bool droppable = role != GpioRole::fault_lamp;
  if (droppable && active && dropped_.load()) return;
  const bool taken = lines_->write(role, active);
  // Another thread may have called drop() between the first check and the write, so the check is repeated
  // after the write.
  if (droppable && dropped_.load()) lines_->write(role, false);
  written = active;
  if (!taken && !lost_) lose(clock_.now());
}

void Panel::drop() noexcept {
  dropped_.store(true);
  lines_->write(GpioRole::enable, false);
  lines_->write(GpioRole::ready_lamp, false);
}

void Panel::tell(PanelEvent::Kind kind, Nanoseconds now) noexcept {
  shared_.panel_events.push(PanelEvent{kind, now});
}

namespace {

constexpr std::array<int, 8> endings{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGQUIT, SIGXCPU};

std::atomic<Panel*> guarded{nullptr};
std::array<struct sigaction, endings.size()> before;

extern "C" void softgrip_drop_panel(int signal) {
  // The driver library writes a line with one system call, without locks and without allocation. The call is
  // therefore safe in a signal handler.
  if (Panel* const panel = guarded.exchange(nullptr)) panel->drop();
  // SA_RESETHAND has restored the default action of the signal, so the raised signal ends the process.
  ::raise(signal);
}

}  // namespace

PanelGuard::PanelGuard(Panel& panel) noexcept {
  guarded.store(&panel);
  struct sigaction action {};
  action.sa_handler = softgrip_drop_panel;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < endings.size(); ++i) ::sigaction(endings[i], &action, &before[i]);
}

PanelGuard::~PanelGuard() {
  for (std::size_t i = 0; i < endings.size(); ++i) ::sigaction(endings[i], &before[i], nullptr);
  guarded.store(nullptr);
}

}  // namespace softgrip::daemon
