#pragma once
// Describes blocks of earlier versions that contained several effects. In the present version, each effect is
// a separate block. These descriptions determine how a model file with an earlier block is read.

#include <cstddef>
#include <string_view>
#include <vector>

#include "model/registry.h"

namespace softgrip::model {

/// A block of an earlier version. The new blocks that replace the earlier block have keys with the same names
/// as the keys of the earlier block.
struct EarlierBlock {
  std::string_view id;
  std::vector<std::size_t> types;  ///< types of the blocks that replace the earlier block
  /// Key of the earlier block whose number selects one of the new blocks. Empty: each new block is used that
  /// has an effect with the values in the file.
  std::string_view choice;
  bool adds = false;  ///< true: the new blocks together have the same effect as the earlier block
};

/// Returns the earlier block with this id; nullptr if no earlier block has this id. One of the new blocks can
/// have the id of the earlier block.
[[nodiscard]] inline const EarlierBlock* find_earlier_block(std::string_view id) {
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
