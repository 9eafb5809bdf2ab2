#pragma once
// Defines the format of the file of a cause and provides helpers that refer to its parameters by name.
// docs/how-to/add-a-cause.md shows an example.
//
// Each cause is a struct in its own file. A cause with a single form is the struct of that form. A cause with
// several forms lists them as `using Forms = List<...>`. By default, the block of the first form defines id,
// title and station. A cause whose id differs from that of the block declares `id` and `title` itself.
//
// A form is a struct derived from FormOf<Block>, where Block is a block of the catalogue:
//   static Starts starts(const Scales&);                   start points of fits, at least one
//   static Bounds bounds(const Scales&, const model::Model&);  limits beyond which the block would have the
//                                                          same effect as another cause
//   static constexpr std::array<Parameter, N> fitted{...}; parameters that a fit changes; default: all
//   static bool holds(const model::BlockSpec&);            returns true if the block has this form;
//                                                          required if several forms share a block type
//   static constexpr bool free_form = true;                the form can follow any slow signal, so it is
//                                                          named only if no physical law is nearly as good
//
// A cause must declare:
//   static constexpr WhenChanged when_changed{words, {step, step}, {{{number, way}, ...}}, size};
//                                                          texts for the operator of a rig that has the
//                                                          cause; `number` and `way` name the indicators
//                                                          of a recorded grip that change (health_sign.h);
//                                                          `size` is optional and selects the quantity
//                                                          that states the size of the change (SizedBy)
//
// A cause may also declare:
//   static constexpr Column needs = ...;                   the column that its test requires
//   static constexpr std::array advice{Advice::...};       actions that separate the cause from other
//                                                          causes if no waveform separates them
//   static constexpr std::string_view indistinguishable = "...";
//       id of a cause that gives equal readings for every command
//   static constexpr std::array<std::string_view, N> counterparts{...};
//       ids of causes that may explain the same effect, in the order of testing: sensor causes for an
//       actuator or load cause, and actuator or load causes for a sensor cause
//   static constexpr std::array<std::string_view, N> confounded_with{...};
//       ids of causes that may be present too; in this case, the parameters of this cause are more uncertain
//       than its fit shows
//   static constexpr bool is_stop = true;                  the displacement stops at a position
//   static constexpr bool makes_distinguishable = true;
//       the block has memory and acts between actuator and sensor, so equal causes before and behind the
//       block give different readings
//   static constexpr bool is_ideal = true;
//       no mechanism matches this ideal exactly, so another cause with an equal loss and equally many
//       parameters is named instead
//   static constexpr std::string_view sensor_shape = "...";
//       description of the static curve of the sensor, which a gauge check can detect
//   static constexpr Appears appears = ...;
//       readings in which the effect of the cause must appear (evidence/signature.h)
//   static constexpr bool found_by_fitting = false;
//       a fit of a trajectory cannot find the cause, so the cause has no start points

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/health_sign.h"
#include "sysid/diagnosis/causes/scales.h"
#include "sysid/evidence/signature.h"

namespace softgrip::sysid {

/// Actions with which an operator separates causes that no waveform separates. An action separates two causes
/// if it is in the lists of both causes.
enum class Advice : std::uint8_t {
  change_load,         ///< change the load, move the object, or compare the sensor with a gauge
  leave_vented,        ///< leave the finger vented for an hour and read the sensor zero
  record_temperature,  ///< record the temperature
  /// Record the temperature and vary it. This action separates the cause from all other causes.
  vary_temperature,
};

/// Quantity that states the size of a change, and the rule by which this quantity is computed from the fitted
/// parameters.
struct SizedBy {
  enum class Of : std::uint8_t {
    full_pressure,  ///< mean effect on the readings at pressures above 90 % of the largest pressure
    /// Mean effect on the readings at pressures above 90 % of the largest pressure, divided by the span of
    /// the readings.
    span,
    largest,    ///< largest effect on the reading, with its sign
    amplitude,  ///< magnitude of the largest effect on the reading
    number,     ///< value of a parameter of the block
  };
  Of of = Of::full_pressure;
  std::string_view what = "effect at full pressure";
  std::string_view unit{};  ///< unit of the quantity; empty: the unit of the readings
  /// Name of the parameter if `of` is Of::number. A form without this parameter uses Of::full_pressure.
  std::string_view number{};
  double factor = 1;
};

/// Texts for the operator if a finger has developed the cause since its baseline was recorded. Empty: a
/// finger does not develop this cause.
struct WhenChanged {
  std::string_view words;                      ///< description of the change, for example "the finger rings"
  std::array<std::string_view, 2> next_steps;  ///< actions for the operator; the quicker action comes first
  /// Indicators of recorded grips that the cause changes; unused elements have default values.
  HealthSigns signs{};
  SizedBy size{};  ///< rule for the size of the change
};

/// Range in which a value may lie.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// List of types, for example the forms of one cause or all causes of the registry.
template <class... T>
struct List {};

/// Members that all forms of causes have in common. The template parameter `Block` is the class template of
/// the block.
template <template <class> class Block>
struct FormOf {
  using BlockType = Block<double>;
  static constexpr std::string_view id = BlockType::info.id;

  /// A parameter of the block, stated by its name. A name that the block does not have is a compile-time
  /// error.
  struct Parameter {
    std::size_t index;
    // NOLINTNEXTLINE(google-explicit-constructor): a name is accepted wherever a parameter is expected.
    consteval Parameter(const char* name) : index(0) {
      while (Block<double>::parameters.at(index).name != std::string_view(name)) ++index;
    }
  };

  using Values = std::vector<double>;
  using Starts = std::vector<Values>;

  struct Value {
    Parameter parameter;
    double value;
  };
  struct Axis {
    Parameter parameter;
    std::vector<double> values;
  };
  struct Bound {
    Parameter parameter;
    double lower = 0;
    double upper = std::numeric_limits<double>::infinity();
  };
  using Bounds = std::vector<Bound>;

  /// Returns the parameter values of the block. Parameters that are not in `given` get their neutral value. A
  /// parameter without neutral value gets its default value.
  [[nodiscard]] static Values start(std::initializer_list<Value> given) {
    Values values;
    for (const model::ParameterSpec& spec : Block<double>::parameters)
      values.push_back(spec.neutral == spec.neutral ? spec.neutral : spec.default_value);
    for (const Value& value : given) values[value.parameter.index] = value.value;
    return values;
  }

  /// Returns one start point for each combination of the given parameter values. The value of the last
  /// parameter varies fastest.
  [[nodiscard]] static Starts every(std::initializer_list<Axis> axes) {
    Starts all{start({})};
    for (const Axis& axis : axes) {
      Starts next;
      for (const Values& part : all) {
        for (const double value : axis.values) {
          next.push_back(part);
          next.back()[axis.parameter.index] = value;
        }
      }
      all = std::move(next);
    }
    return all;
  }
};

}  // namespace softgrip::sysid
