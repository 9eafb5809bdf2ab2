// Simulates a gauge check with the sensor blocks of the simulated model. The model of the finger is not used.

#include <cmath>
#include <optional>
#include <variant>

#include "base/clock.h"
#include "model/blocks/bouc_wen.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "simulation/plant/simulated_board.h"
#include "tools/investigation/experiment_rig.h"

namespace softgrip::tools {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds interval = 10'000'000;
/// Duration of the average at the end of a reading [s]. Before this average, the target moves to its
/// position.
constexpr double averaged_s = 2;
/// Largest length that a simulated output can represent [mm].
constexpr double longest_mm = 10'000;

/// Returns a model with a gain of 1 mm per kPa and the sensor blocks of `truth`.
model::Model sensor_alone(const model::Model& truth) {
  model::Model sensor =
      model::only(truth, [](const model::BlockInfo& info) { return info.station == model::Station::sensor; });
  model::BlockSpec gain = model::default_block(model::block_type<model::BoucWen>());
  gain.values[*model::find_parameter(gain, "alpha_mm_per_kpa")] = 1;
  gain.values[*model::find_parameter(gain, "beta_mm_per_kpa")] = 0;
  return model::with_block(std::move(sensor), std::move(gain));
}

class SensorBench {
 public:
  SensorBench(simulation::SimulatedBoardSettings settings, std::size_t channel)
      : channel_(channel), board_(on_bench(std::move(settings), channel), clock_) {}

  /// Returns the mean reading at a position; nullopt if the sensor gives no valid reading at this position.
  std::optional<sysid::GaugeReading> read(double position_mm) {
    if (position_mm < 0) return std::nullopt;
    std::vector<double> commands(board_.channels(), 0.0);
    commands[channel_] = position_mm;
    std::vector<model::Reading> readings(board_.channels());
    if (board_.connect(1s) != drivers::BusStatus::ok) return std::nullopt;
    const auto steps = static_cast<int>(std::lround(sysid::seconds_per_reading * 1e9 / interval));
    const auto averaged = static_cast<int>(std::lround(averaged_s * 1e9 / interval));
    double sum = 0, count = 0;
    for (int i = 0; i < steps; ++i) {
      clock_.advance(interval);
      if (board_.exchange(commands, readings, 1s) != drivers::BusStatus::ok) return std::nullopt;
      if (i < steps - averaged) continue;
      if (readings[channel_].validity != model::Validity::valid) return std::nullopt;
      sum += readings[channel_].displacement_mm;
      count += 1;
    }
    return sysid::GaugeReading{position_mm, sum / count, count};
  }

 private:
  static simulation::SimulatedBoardSettings on_bench(simulation::SimulatedBoardSettings settings,
                                                     std::size_t channel) {
    settings.events.clear();
    simulation::SimulatedChannel& own = settings.channels[channel];
    own.plant.model = sensor_alone(own.plant.model);
    own.plant.object.reset();
    own.valve_max_kpa = longest_mm;
    own.output_bits = 0;
    return settings;
  }

  std::size_t channel_;
  VirtualClock clock_;
  simulation::SimulatedBoard board_;
};

}  // namespace

GaugeTaker simulated_gauge(ExperimentRig rig) {
  return [rig = std::move(rig)](const std::vector<double>& positions_mm,
                                const std::string& folder) -> tl::expected<sysid::GaugeFile, NotPlayed> {
    SensorBench bench(std::get<simulation::SimulatedBoardSettings>(rig.rig.board), rig.channel);
    std::vector<sysid::GaugeReading> readings;
    for (const double position : positions_mm) {
      if (const auto reading = bench.read(position)) readings.push_back(*reading);
    }
    return gauge_file_of(readings, folder);
  };
}

}  // namespace softgrip::tools
