#pragma once
// The list of blocks: the only one in the project. To add a block, write model/blocks/<id>.h and add its line
// here; everything else (files, names, bounds, reference page, chain, tests of properties) follows.

#include <variant>

#include "model/blocks/actuator_threshold.h"
#include "model/blocks/ageing.h"
#include "model/blocks/asymmetric_hysteresis.h"
#include "model/blocks/backlash.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/contact.h"
#include "model/blocks/inertia.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/outliers.h"
#include "model/blocks/periodic_disturbance.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/quantisation.h"
#include "model/blocks/rate_dependent_hysteresis.h"
#include "model/blocks/sensor_drift.h"
#include "model/blocks/sensor_lag.h"
#include "model/blocks/sensor_noise.h"
#include "model/blocks/sensor_nonlinearity.h"
#include "model/blocks/sensor_saturation.h"
#include "model/blocks/slow_creep.h"
#include "model/blocks/stiffening.h"
#include "model/blocks/stress_softening.h"
#include "model/blocks/supply_sag.h"
#include "model/blocks/thermal_gain.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/catalogue.h"

namespace softgrip::model {

/// One block of any type. The index of a type is BlockSpec::type and its place in catalogue(). Listed in the
/// order in which the signal meets them; with_block() puts blocks there.
template <class T>
using AnyBlock = std::variant<TransportDelay<T>,           //
                              ValveDeadband<T>,            //
                              ValveLag<T>,                 //
                              SupplySag<T>,                //
                              PressureSaturation<T>,       //
                              ActuatorThreshold<T>,        //
                              StressSoftening<T>,          //
                              BoucWen<T>,                  //
                              KelvinVoigt<T>,              //
                              SlowCreep<T>,                //
                              AsymmetricHysteresis<T>,     //
                              RateDependentHysteresis<T>,  //
                              Stiffening<T>,               //
                              ThermalGain<T>,              //
                              Ageing<T>,                   //
                              Inertia<T>,                  //
                              Contact<T>,                  //
                              Backlash<T>,                 //
                              SensorLag<T>,                //
                              SensorNonlinearity<T>,       //
                              SensorDrift<T>,              //
                              PeriodicDisturbance<T>,      //
                              SensorNoise<T>,              //
                              Outliers<T>,                 //
                              SensorSaturation<T>,         //
                              Quantisation<T>>;

/// BlockSpec::type of a block.
template <class Block>
constexpr std::size_t block_type() {
  return []<std::size_t... I>(std::index_sequence<I...>) {
    return ((std::is_same_v<std::variant_alternative_t<I, AnyBlock<double>>, Block> ? I : 0) + ...);
  }
  (std::make_index_sequence<std::variant_size_v<AnyBlock<double>>>{});
}

}  // namespace softgrip::model
