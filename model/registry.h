#pragma once
// Contains the list of all blocks. To add a block, write model/blocks/<id>.h and add the block to this list.
// Model files, the reference page, the chain and the property tests use the list.

#include <cstddef>
#include <type_traits>
#include <variant>

#include "model/blocks/actuator_threshold.h"
#include "model/blocks/ageing.h"
#include "model/blocks/asymmetric_bouc_wen.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/backlash.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/clock_offset.h"
#include "model/blocks/contact.h"
#include "model/blocks/crescent_hysteresis.h"
#include "model/blocks/duhem_hysteresis.h"
#include "model/blocks/inertia.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/leak.h"
#include "model/blocks/linear_modes.h"
#include "model/blocks/outliers.h"
#include "model/blocks/periodic_disturbance.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_dependent_creep.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/pressure_scale.h"
#include "model/blocks/pseudo_elastic_softening.h"
#include "model/blocks/quantisation.h"
#include "model/blocks/rate_dependent_saturation.h"
#include "model/blocks/rate_dependent_width.h"
#include "model/blocks/rate_limit.h"
#include "model/blocks/relaxing_friction.h"
#include "model/blocks/running_in.h"
#include "model/blocks/sampling.h"
#include "model/blocks/sensor_drift.h"
#include "model/blocks/sensor_lag.h"
#include "model/blocks/sensor_noise.h"
#include "model/blocks/sensor_nonlinearity.h"
#include "model/blocks/sensor_piecewise_drift.h"
#include "model/blocks/sensor_saturation.h"
#include "model/blocks/sensor_sinusoidal_drift.h"
#include "model/blocks/sensor_warm_up.h"
#include "model/blocks/slow_creep.h"
#include "model/blocks/stiffening.h"
#include "model/blocks/stress_softening.h"
#include "model/blocks/supply_sag.h"
#include "model/blocks/thermal_gain.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/blocks/valve_stiction.h"
#include "model/blocks/wear.h"
#include "model/catalogue.h"

namespace softgrip::model {

/// A list of block types. Each block in the list meets the requirements of block.h.
template <template <class> class... Block>
struct BlockList {
  template <class T>
  using Any = std::variant<Block<T>...>;

  static_assert((keeps_contract<Block, double>() && ...));
  static_assert((keeps_contract<Block, Dual<double>>() && ...));

  /// Returns the index in the list of the block type B over double. If the list does not contain B, returns
  /// the length of the list.
  template <class B>
  static consteval std::size_t index_of() {
    std::size_t index = 0;
    (void)((std::is_same_v<B, Block<double>> || (++index, false)) || ...);
    return index;
  }
};

/// All blocks, in the order in which the signal passes through the blocks. with_block() inserts a block in
/// this order.
using Blocks = BlockList<TransportDelay,           //
                         ValveDeadband,            //
                         ValveStiction,            //
                         ValveLag,                 //
                         AsymmetricValveLag,       //
                         RateLimit,                //
                         PressureRegulator,        //
                         SupplySag,                //
                         PressureSaturation,       //
                         ChamberLag,               //
                         PressureScale,            //
                         Leak,                     //
                         ActuatorThreshold,        //
                         StressSoftening,          //
                         PseudoElasticSoftening,   //
                         BoucWen,                  //
                         PrandtlIshlinskii,        //
                         KelvinVoigt,              //
                         PressureDependentCreep,   //
                         LinearModes,              //
                         SlowCreep,                //
                         DuhemHysteresis,          //
                         CrescentHysteresis,       //
                         AsymmetricBoucWen,        //
                         RelaxingFriction,         //
                         RateDependentWidth,       //
                         RateDependentSaturation,  //
                         Characteristic,           //
                         Stiffening,               //
                         ThermalGain,              //
                         Ageing,                   //
                         RunningIn,                //
                         Wear,                     //
                         Inertia,                  //
                         Contact,                  //
                         Backlash,                 //
                         SensorLag,                //
                         ClockOffset,              //
                         SensorNonlinearity,       //
                         SensorDrift,              //
                         SensorWarmUp,             //
                         SensorSinusoidalDrift,    //
                         SensorPiecewiseDrift,     //
                         PeriodicDisturbance,      //
                         SensorNoise,              //
                         Outliers,                 //
                         SensorSaturation,         //
                         Sampling,                 //
                         Quantisation>;

/// A variant that contains one block of any registered type. The index of a type in the variant equals
/// BlockSpec::type and the index of the type in catalogue().
template <class T>
using AnyBlock = Blocks::Any<T>;

/// Returns the value of BlockSpec::type for a block type. The function has two forms: block_type<ValveLag>()
/// and, with a number type, block_type<ValveLag<double>>().
template <template <class> class Block>
[[nodiscard]] consteval std::size_t block_type() {
  static_assert(Blocks::index_of<Block<double>>() < std::variant_size_v<AnyBlock<double>>, "not registered");
  return Blocks::index_of<Block<double>>();
}
template <class Block>
[[nodiscard]] consteval std::size_t block_type() {
  static_assert(Blocks::index_of<Block>() < std::variant_size_v<AnyBlock<double>>, "not registered");
  return Blocks::index_of<Block>();
}

}  // namespace softgrip::model
