#include "daemon/service/panel_run.h"

#include <algorithm>
#include <latch>
#include <utility>

namespace softgrip::daemon {

namespace {

/// Returns the priority of the panel: 2 below the priority of the loop, but at least 1; 0 without real-time
/// scheduling.
int priority_of(const rig::RealTimeSettings& settings) {
  return settings.priority > 0 ? std::max(settings.priority - 2, 1) : 0;
}

std::string message_of(const rig::GpioSettings& settings, const drivers::GpioFailure& failure) {
  document::Problem problem = settings.places[failure.line];
  problem.message = failure.message;
  problem.hint = failure.hint;
  document::Problems problems;
  problems.add(std::move(problem));
  std::string text = problems.format();
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace

bool PanelRun::open(Outcome& outcome) {
  if (!rig_.gpio) return true;
  const auto& open_lines = options_.open_gpio ? options_.open_gpio : drivers::open_gpio_lines;
  auto lines = open_lines(rig_.gpio->lines);
  if (lines) {
    panel_.emplace(std::move(*lines), *rig_.gpio, clock_, shared_, loop_);
    guard_.emplace(*panel_);
    return true;
  }
  const drivers::GpioFailure& failure = lines.error();
  outcome.ending =
      failure.kind == drivers::GpioFailure::Kind::refused ? Ending::gpio_refused : Ending::gpio_failed;
  outcome.message = message_of(*rig_.gpio, failure);
  return false;
}

void PanelRun::start(RealTimeReport& report) {
  if (!panel_) return;
  RealTimeReport own;
  std::latch ready(1);
  thread_ = Thread(
      {.name = "softgrip-panel"},
      [&, this] {
        prepare_thread(rig_.real_time, priority_of(rig_.real_time), "the panel", own);
        ready.count_down();
        panel_->run();
      },
      [](const std::string&) {});
  ready.wait();
  report.append(own);
}

void PanelRun::stop() noexcept {
  if (!panel_) return;
  panel_->drop();
  panel_->stop();
  if (thread_.joinable()) thread_.join();
  guard_.reset();
  panel_.reset();
}

}  // namespace softgrip::daemon
