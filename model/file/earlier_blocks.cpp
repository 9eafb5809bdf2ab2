#include "model/file/earlier_blocks.h"

#include "model/registry.h"

namespace softgrip::model {

const EarlierBlock* find_earlier_block(std::string_view id) {
  static const std::vector<EarlierBlock> all{
      {"valve_deadband", {block_type<ValveDeadband>(), block_type<ValveStiction>()}, "form"},
      {"asymmetric_hysteresis", {block_type<DuhemHysteresis>(), block_type<AsymmetricBoucWen>()}, "", true},
      {"rate_dependent_hysteresis",
       {block_type<RelaxingFriction>(), block_type<RateDependentWidth>(),
        block_type<RateDependentSaturation>()},
       "",
       true},
      // The chain multiplies the gains of these three blocks, but the earlier block added the gains.
      // Therefore, `adds` is false.
      {"ageing", {block_type<Ageing>(), block_type<RunningIn>(), block_type<Wear>()}, "", false},
      {"sensor_drift",
       {block_type<SensorDrift>(), block_type<SensorWarmUp>(), block_type<SensorSinusoidalDrift>(),
        block_type<SensorPiecewiseDrift>()},
       "",
       true}};
  for (const EarlierBlock& block : all) {
    if (block.id == id) return &block;
  }
  return nullptr;
}

}  // namespace softgrip::model
