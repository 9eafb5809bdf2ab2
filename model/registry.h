#pragma once
// The list of blocks: the only one in the project. To add a block, write model/blocks/<id>.h and add its line
// here; everything else (files, names, bounds, reference page, chain, tests of properties) follows.

#include <variant>

#include "model/blocks/bouc_wen.h"
#include "model/blocks/contact.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/quantisation.h"
#include "model/blocks/sensor_noise.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/catalogue.h"

namespace softgrip::model {

/// One block of any type. The index of a type is BlockSpec::type and its place in catalogue(). Listed by
/// station, in the order in which the signal meets them.
template <class T>
using AnyBlock = std::variant<TransportDelay<T>,      //
                              ValveLag<T>,            //
                              PressureSaturation<T>,  //
                              BoucWen<T>,             //
                              KelvinVoigt<T>,         //
                              Contact<T>,             //
                              SensorNoise<T>,         //
                              Quantisation<T>>;

}  // namespace softgrip::model
