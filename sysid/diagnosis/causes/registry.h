#pragma once
// Lists all causes of the project. To add a cause, write its file and add the cause to the list `All`
// (docs/how-to/add-a-cause.md). Each block of the catalogue must belong to a cause of this list or to the
// list `NoCauses`. Otherwise the compiler reports an error.

#include "model/registry.h"
#include "sysid/diagnosis/causes/actuator_threshold.h"
#include "sysid/diagnosis/causes/ageing.h"
#include "sysid/diagnosis/causes/asymmetric_hysteresis.h"
#include "sysid/diagnosis/causes/backlash.h"
#include "sysid/diagnosis/causes/clock_offset.h"
#include "sysid/diagnosis/causes/contact.h"
#include "sysid/diagnosis/causes/hysteresis_shape.h"
#include "sysid/diagnosis/causes/inertia.h"
#include "sysid/diagnosis/causes/leak.h"
#include "sysid/diagnosis/causes/outliers.h"
#include "sysid/diagnosis/causes/periodic_disturbance.h"
#include "sysid/diagnosis/causes/pressure_saturation.h"
#include "sysid/diagnosis/causes/pressure_scale.h"
#include "sysid/diagnosis/causes/rate_dependent_hysteresis.h"
#include "sysid/diagnosis/causes/sampling.h"
#include "sysid/diagnosis/causes/sensor_drift.h"
#include "sysid/diagnosis/causes/sensor_lag.h"
#include "sysid/diagnosis/causes/sensor_nonlinearity.h"
#include "sysid/diagnosis/causes/sensor_saturation.h"
#include "sysid/diagnosis/causes/slow_creep.h"
#include "sysid/diagnosis/causes/stiffening.h"
#include "sysid/diagnosis/causes/stress_softening.h"
#include "sysid/diagnosis/causes/supply_sag.h"
#include "sysid/diagnosis/causes/thermal_gain.h"
#include "sysid/diagnosis/causes/transport_delay.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/causes/valve_lag.h"

namespace softgrip::sysid::causes {

using All = List<ActuatorThreshold,        //
                 Ageing,                   //
                 AsymmetricHysteresis,     //
                 Backlash,                 //
                 ClockOffset,              //
                 Contact,                  //
                 HysteresisShape,          //
                 Inertia,                  //
                 Leak,                     //
                 Outliers,                 //
                 PeriodicDisturbance,      //
                 PressureSaturation,       //
                 PressureScale,            //
                 RateDependentHysteresis,  //
                 Sampling,                 //
                 SensorDrift,              //
                 SensorLag,                //
                 SensorNonlinearity,       //
                 SensorSaturation,         //
                 SlowCreep,                //
                 Stiffening,               //
                 StressSoftening,          //
                 SupplySag,                //
                 ThermalGain,              //
                 TransportDelay,           //
                 ValveDeadband,            //
                 ValveLag>;

/// Blocks that do not belong to a cause. They are part of the base structure or describe the random error of
/// the sensor.
using NoCauses = List<model::AsymmetricValveLag<double>,      //
                      model::PressureRegulator<double>,       //
                      model::RateLimit<double>,               //
                      model::ChamberLag<double>,              //
                      model::BoucWen<double>,                 //
                      model::KelvinVoigt<double>,             //
                      model::PressureDependentCreep<double>,  //
                      model::LinearModes<double>,             //
                      model::Characteristic<double>,          //
                      model::SensorNoise<double>,             //
                      model::Quantisation<double>>;

}  // namespace softgrip::sysid::causes
