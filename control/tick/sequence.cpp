#include "control/tick/sequence.h"

#include <algorithm>
#include <bit>

namespace softgrip::control {

namespace {

/// Computes an FNV-1a hash over the bytes of the settings on which a prepared sequence depends.
class Key {
 public:
  void add(double value) { add_bits(std::bit_cast<std::uint64_t>(value)); }
  void add(const std::string& text) {
    add_bits(text.size());
    for (const char c : text) add_bits(static_cast<unsigned char>(c));
  }
  void add_bits(std::uint64_t bits) {
    for (int i = 0; i < 8; ++i) value_ = (value_ ^ (bits >> 8 * i & 0xff)) * 1099511628211ULL;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

}  // namespace

std::uint64_t rig_key(const RigSettings& settings) noexcept {
  Key key;
  key.add(settings.rate_hz);
  for (const ChannelSettings& channel : settings.channels) {
    key.add(channel.name);
    key.add(channel.limits.pressure_min_kpa);
    key.add(channel.limits.pressure_max_kpa);
    key.add(resting_kpa(channel.limits));
    key.add(channel.limits.displacement_min_mm);
    key.add(channel.limits.displacement_max_mm);
    key.add_bits((channel.pressure_measured ? 1U : 0U) | (channel.displacement_used ? 2U : 0U));
    if (channel.feedforward.kind != FeedforwardKind::planned) continue;
    key.add(channel.limits.slew_up_kpa_per_s);
    key.add(channel.limits.slew_down_kpa_per_s);
    key.add(channel.feedforward.extra_latency_s);
    for (const model::BlockSpec& block : channel.model.blocks) {
      key.add_bits(block.type);
      for (const double value : block.values) key.add(value);
    }
  }
  return key.value();
}

double cycle_s(const Profile& profile) noexcept {
  if (profile.signal) return model::duration_s(*profile.signal);
  return profile.points.empty() ? 0 : profile.points.back().time_s;
}

double duration_s(const Profile& profile) noexcept {
  return cycle_s(profile) * profile.cycles;
}

namespace {

double value_of_points(const std::vector<Point>& points, double time_s) noexcept {
  const auto after = std::upper_bound(points.begin(), points.end(), time_s,
                                      [](double t, const Point& point) { return t < point.time_s; });
  if (after == points.begin()) return points.front().pressure_kpa;
  if (after == points.end()) return points.back().pressure_kpa;
  const Point& before = *(after - 1);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return before.pressure_kpa + share * (after->pressure_kpa - before.pressure_kpa);
}

}  // namespace

double value_at(const Profile& profile, double time_s) noexcept {
  const double one = cycle_s(profile);
  double in_cycle = std::clamp(time_s, 0.0, one * profile.cycles);
  if (one > 0) {
    const double done = std::min(std::floor(in_cycle / one), static_cast<double>(profile.cycles) - 1);
    in_cycle -= done * one;
  }
  if (profile.signal) return profile.scale * model::value_kpa(*profile.signal, in_cycle);
  return profile.points.empty() ? 0 : value_of_points(profile.points, in_cycle);
}

}  // namespace softgrip::control
