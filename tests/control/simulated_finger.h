#pragma once
// Simulates a finger with a model of its own and with a time step that is smaller than the tick of the
// controller. The controller sends commands to this finger and reads its sensor, as it does with a board.

#include <cstdint>
#include <random>

#include "control/tick/settings.h"
#include "model/chain.h"
#include "model/file/model_file.h"
#include "model/reading.h"

namespace softgrip::control::sim {

inline constexpr double tick_s = 0.005;
inline constexpr Nanoseconds tick_ns = 5'000'000;

/// Reads the model with this name in config/models/.
inline model::Model model_named(const std::string& name) {
  document::Problems problems;
  auto model =
      model::load_model(std::string(SOFTGRIP_SOURCE_DIR) + "/config/models/" + name + ".yaml", problems);
  if (!model) throw std::runtime_error(problems.format());
  return *model;
}

/// Returns channel settings for bench_twin, with the values that a rig file would contain.
inline ChannelSettings twin_settings() {
  ChannelSettings settings;
  settings.name = "left";
  settings.model = model_named("bench_twin");
  settings.pid = {0.5, 3, 0, 0.02, 1, AntiWindup::back_calculation, 0.3};
  settings.feedforward.kind = FeedforwardKind::full_model;
  settings.limits = {0, 60, 400, 400, 0, 25, 1};
  settings.plausibility.max_speed_mm_per_s = 2000;
  return settings;
}

/// Simulates the board and the finger together. write() sends a command and reads the sensor, as an exchange
/// with a board does. The controller uses this reading in the next tick, when the reading is one tick old.
class SimulatedFinger {
 public:
  SimulatedFinger(const model::Model& model, double noise_mm, std::uint64_t seed)
      : chain_(model, {}, tick_s / sub_steps), noise_mm_(noise_mm), random_(seed) {}

  /// Simulates one tick in which the command is constant. Returns the reading at the beginning of the tick.
  model::Reading write(double command_kpa, Nanoseconds now) {
    chain_.step(0, command_kpa);
    model::Reading reading;
    reading.displacement_mm = chain_.reading_mm() + noise_mm_ * normal_(random_);
    reading.sampled_at = now;
    reading.sequence = ++sequence_;
    reading.validity = model::Validity::valid;
    for (int i = 0; i < sub_steps; ++i) chain_.step(tick_s / sub_steps, command_kpa);
    return reading;
  }
  /// Returns the true displacement [mm] at the end of the last tick.
  [[nodiscard]] double displacement_mm() const { return chain_.after(model::Station::load); }

 private:
  static constexpr int sub_steps = 4;
  model::Chain<double> chain_;
  double noise_mm_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uint32_t sequence_ = 0;
};

}  // namespace softgrip::control::sim
