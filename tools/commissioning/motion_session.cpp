#include "tools/commissioning/motion_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/grid.h"
#include "daemon/loop/bus.h"
#include "daemon/service/signals.h"
#include "rig/rig_file.h"

namespace softgrip::tools {
namespace {

using drivers::BusStatus;
using FailureKind = MotionFailure::Kind;

/// How long the board may take to confirm that everything is down, beyond the way there.
constexpr double confirmation_s = 1;
/// How long the board may be silent on the way; nothing moves meanwhile.
constexpr double silence_s = 1;
constexpr std::size_t times_kept = 100'000;

bool loses_session(BusStatus status) {
  return status == BusStatus::disconnected || status == BusStatus::timed_out ||
         status == BusStatus::bad_reply;
}

/// Mean and spread while it goes (Welford, Technometrics 4, 1962).
class Gathering {
 public:
  void add(double value) {
    ++sample_.count;
    const double step = value - sample_.mean;
    sample_.mean += step / static_cast<double>(sample_.count);
    squares_ += step * (value - sample_.mean);
    sample_.lowest = sample_.count == 1 ? value : std::min(sample_.lowest, value);
    sample_.highest = sample_.count == 1 ? value : std::max(sample_.highest, value);
  }
  void miss(model::Validity why) {
    ++sample_.invalid;
    sample_.why = why;
  }
  [[nodiscard]] Sample result() const {
    Sample sample = sample_;
    if (sample.count > 1) sample.deviation = std::sqrt(squares_ / static_cast<double>(sample.count - 1));
    return sample;
  }

 private:
  Sample sample_;
  double squares_ = 0;
};

struct ChannelGathering {
  Gathering displacement;
  Gathering pressure;
  Gathering readback;

  void take(const model::Reading& reading) {
    if (reading.validity == model::Validity::valid) {
      displacement.add(reading.displacement_mm);
    } else {
      displacement.miss(reading.validity);
    }
    if (std::isfinite(reading.pressure_kpa)) pressure.add(reading.pressure_kpa);
    if (std::isfinite(reading.command_readback_kpa)) readback.add(reading.command_readback_kpa);
  }
};

Nanoseconds period_of(const rig::RigFile& rig, const drivers::Board& board) {
  return std::max(nanoseconds(1 / rig.settings.rate_hz), nanoseconds(board.budget().exchange_s));
}

}  // namespace

MotionSession::MotionSession(const rig::RigFile& rig, drivers::Board& board, Pace& pace)
    : rig_(rig), board_(board), pace_(pace), period_(period_of(rig, board)), readings_(board.channels()) {
  for (const control::ChannelSettings& channel : rig.settings.channels) {
    commands_.push_back(channel.limits.pressure_min_kpa);
  }
  targets_ = commands_;
}

MotionSession::~MotionSession() {
  if (moved_) leave();
}

MotionSession::Expected<void> MotionSession::connect() {
  const BusStatus status = board_.connect(rig_.reconnect.connect_deadline);
  connected_ = status == BusStatus::ok;
  if (connected_) return {};
  const std::string detail = board_.detail();
  return tl::unexpected(MotionFailure{
      FailureKind::bus, board_.describe() + ": " + (detail.empty() ? drivers::name_of(status) : detail)});
}

BusStatus MotionSession::exchange() noexcept {
  if (!connected_) {
    connected_ = board_.connect(rig_.reconnect.connect_deadline) == BusStatus::ok;
    if (!connected_) return BusStatus::disconnected;
  }
  const Nanoseconds began = pace_.now();
  const BusStatus status = board_.exchange(
      commands_, readings_, std::chrono::nanoseconds(nanoseconds(rig_.loop.exchange_deadline_s)));
  if (status == BusStatus::ok && exchange_times_s_.size() < times_kept) {
    exchange_times_s_.push_back(seconds(pace_.now() - began));
  }
  if (loses_session(status)) connected_ = false;
  return status;
}

/// Waits for the next point of the grid, exchanges, and judges what it means to go on.
MotionSession::Expected<void> MotionSession::step(const Watch& watch) {
  if (pace_.stopped()) return tl::unexpected(MotionFailure{FailureKind::stopped, "stopped by the user"});
  const Nanoseconds now = pace_.now();
  due_ = due_ == 0 || now > due_ + period_ ? now : due_ + period_;
  pace_.sleep_until(due_);
  const Nanoseconds began = pace_.now();
  const BusStatus status = exchange();
  if (status == BusStatus::ok) {
    failures_ = 0;
    if (watch) watch(commands_, readings_);
    return {};
  }
  const bool said_by_board = control::inhibits(daemon::fault_of(status));
  const double patience =
      std::max<double>(rig_.settings.faults.bus_down_cycles, silence_s / seconds(period_));
  failures_ += 1 + static_cast<std::uint32_t>((pace_.now() - began) / period_);
  if (!said_by_board && failures_ < patience) return {};
  const std::string detail = board_.detail();
  return tl::unexpected(MotionFailure{FailureKind::bus, detail.empty() ? drivers::name_of(status) : detail});
}

MotionSession::Expected<std::vector<ChannelSample>> MotionSession::sample(double duration_s,
                                                                          const Watch& watch) {
  std::vector<ChannelGathering> gathering(commands_.size());
  const Nanoseconds end = pace_.now() + nanoseconds(duration_s);
  while (pace_.now() < end) {
    const auto done =
        step([&](const std::vector<double>& commands, const std::vector<model::Reading>& readings) {
          for (std::size_t i = 0; i < gathering.size(); ++i) gathering[i].take(readings[i]);
          if (watch) watch(commands, readings);
        });
    if (!done) return tl::unexpected(done.error());
  }
  std::vector<ChannelSample> samples;
  samples.reserve(gathering.size());
  for (const ChannelGathering& channel : gathering) {
    samples.push_back({channel.displacement.result(), channel.pressure.result(), channel.readback.result()});
  }
  return samples;
}

void MotionSession::follow_targets(double speed_kpa_per_s) noexcept {
  const double elapsed_s = seconds(period_);
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    const double furthest = speed_kpa_per_s * elapsed_s;
    const double wanted = std::clamp(targets_[i], commands_[i] - furthest, commands_[i] + furthest);
    commands_[i] =
        control::limit(rig_.settings.channels[i].limits, wanted, commands_[i], elapsed_s).command_kpa;
  }
}

std::optional<MotionFailure> MotionSession::beyond() const {
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const control::ChannelSettings& channel = rig_.settings.channels[i];
    const bool seen = channel.displacement_used && readings_[i].validity == model::Validity::valid;
    if (!seen || !control::displacement_beyond(channel.limits, readings_[i].displacement_mm)) continue;
    return MotionFailure{FailureKind::beyond,
                         "the finger `" + channel.name + "` left its displacement limits"};
  }
  return std::nullopt;
}

MotionSession::Expected<void> MotionSession::ramp(std::size_t channel, double to_kpa, double speed_kpa_per_s,
                                                  const Watch& watch) {
  const control::LimitSettings& limits = rig_.settings.channels[channel].limits;
  targets_[channel] = std::clamp(to_kpa, limits.pressure_min_kpa, limits.pressure_max_kpa);
  moved_ = true;
  while (commands_[channel] != targets_[channel]) {
    const std::vector<double> before = commands_;
    follow_targets(speed_kpa_per_s);
    if (auto done = step(watch); !done) return done;
    // What was not written has not moved anything: no jump when the board is back.
    if (failures_ > 0) commands_ = before;
    if (const auto failure = beyond()) return tl::unexpected(*failure);
  }
  return {};
}

MotionSession::Expected<void> MotionSession::wait(const std::function<bool()>& done) {
  while (!done()) {
    if (auto stepped = step({}); !stepped) return stepped;
  }
  return {};
}

bool MotionSession::leave() noexcept {
  double fastest = 0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    targets_[i] = rig_.settings.channels[i].limits.pressure_min_kpa;
    fastest = std::max(fastest, rig_.settings.channels[i].limits.slew_down_kpa_per_s);
  }
  Nanoseconds give_up = 0;
  // Down in any case: a board that comes back late gets the end of the way, which is what is wanted of it.
  while (true) {
    follow_targets(fastest);
    const bool down = commands_ == targets_;
    if (down && give_up == 0) give_up = pace_.now() + nanoseconds(confirmation_s);
    due_ = std::max(due_ + period_, pace_.now());
    pace_.sleep_until(due_);
    const BusStatus status = exchange();
    if (down && status == BusStatus::ok) {
      moved_ = false;
      return true;
    }
    if (give_up != 0 && pace_.now() >= give_up) return false;
  }
}

struct RealPace::Parts {
  daemon::Signals signals;
  MonotonicClock clock;
  bool stopped = false;
};

RealPace::RealPace() : parts_(std::make_unique<Parts>()) {}
RealPace::~RealPace() = default;

Nanoseconds RealPace::now() noexcept {
  return parts_->clock.now();
}

void RealPace::sleep_until(Nanoseconds due) noexcept {
  softgrip::sleep_until(due);
}

bool RealPace::stopped() noexcept {
  parts_->stopped = parts_->stopped || parts_->signals.wait(0) != 0;
  return parts_->stopped;
}

}  // namespace softgrip::tools
