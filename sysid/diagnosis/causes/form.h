#pragma once
// Defines the format of the file of a cause and provides helpers that refer to its parameters by name.
// docs/how-to/add-a-cause.md shows an example.
//
// Each cause is a struct in its own file. A cause with a single form is the struct of that form. A cause with
// several forms lists them as `using Forms = List<...>`. By default, the block of the first form defines id,
// title and station. A cause whose id differs from that of the block declares `id` and `title` itself.
//
// A form is a struct derived from FormOf<Block>, where Block is a block of the catalogue:
//   static Starts starts(const Scales&);                   start points of fits; at least one
//   static Bounds bounds(const Scales&, const model::Model&);  limits beyond which the block would duplicate
//                                                          another effect as a false alternative
//   static constexpr std::array<Parameter, N> fitted{...}; parameters that a fit moves; default: all
//   static bool holds(const model::BlockSpec&);            required if several forms share a block: returns
//                                                          true if the block has this form
//   static constexpr bool free_form = true;                it can follow any slow signal: named only if no
//                                                          law explains nearly as much
//
// A cause must declare:
//   static constexpr WhenChanged when_changed{words, {step, step}, {{{number, way}, ...}}, size};
//                                                          for the operator of a rig that has acquired the
//                                                          cause; `number` and `way` name the indicators
//                                                          of a recorded grip that change (health_sign.h);
//                                                          optionally, the quantity that states the size
//                                                          (SizedBy)
//
// A cause may also declare:
//   static constexpr Column needs = ...;                   the column that its test requires
//   static constexpr std::array advice{Advice::...};       actions that separate it if no waveform does
//   static constexpr std::string_view indistinguishable = "...";
//       a cause with equal readings for every command
//   static constexpr std::array<std::string_view, N> counterparts{...};
//       sensor causes that may replace an actuator or load cause, or the reverse, in the order of testing
//   static constexpr std::array<std::string_view, N> confounded_with{...};
//       causes that increase the uncertainty of its parameters beyond that of its fit, if they are present
//   static constexpr bool is_stop = true;                  the displacement stops at a position
//   static constexpr bool makes_distinguishable = true;
//       has memory and acts between actuator and sensor: equal causes before and behind it give different
//       readings
//   static constexpr bool is_ideal = true;
//       an ideal that no mechanism matches exactly: of two causes with equal loss and equally many
//       parameters, the other one is named
//   static constexpr std::string_view sensor_shape = "...";
//       description of a sensor without memory, which a gauge can detect
//   static constexpr Appears appears = ...;
//       where its effect must appear (evidence/signature.h)
//   static constexpr bool found_by_fitting = false;
//       a fit of a trajectory cannot find it: it has no start points

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

/// Actions that separate causes which no waveform separates. An action separates two causes if both list it.
enum class Advice : std::uint8_t {
  change_load,         ///< change the load, move the object, or hold the sensor against a gauge
  leave_vented,        ///< leave the finger vented for an hour and read the sensor zero
  record_temperature,  ///< record the temperature
  vary_temperature,    ///< record the temperature and vary it; it separates this cause from any other
};

/// The quantity that states the size of a change, and its relation to the fitted parameters.
struct SizedBy {
  enum class Of : std::uint8_t {
    full_pressure,  ///< mean effect at more than 90 % of the largest pressure
    span,           ///< the same as a share of the span of the readings
    largest,        ///< largest effect, with its sign
    amplitude,      ///< largest effect, without its sign
    number,         ///< value of a parameter of the block
  };
  Of of = Of::full_pressure;
  std::string_view what = "at full pressure";
  std::string_view unit{};    ///< empty: unit of the reading
  std::string_view number{};  ///< name of the parameter for `number`; a form without this parameter uses
                              ///< full_pressure
  double factor = 1;
};

/// Texts for the operator of a finger that has acquired the cause since its baseline. Empty: the cause does
/// not develop over time.
struct WhenChanged {
  std::string_view words;                      ///< "the finger rings"
  std::array<std::string_view, 2> next_steps;  ///< actions for the operator, the quicker one first
  HealthSigns signs{};                         ///< effects on indicators of recorded grips; empty: no effect
  SizedBy size{};                              ///< quantity that states the size
};

/// The range of a value.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// A list of forms of a cause, or of causes of the registry.
template <class... T>
struct List {};

/// Common members of all forms. Block is the class template of the block.
template <template <class> class Block>
struct FormOf {
  using BlockType = Block<double>;
  static constexpr std::string_view id = BlockType::info.id;

  /// Refers to a parameter of the block by name. An unknown name is a compile-time error.
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

  /// Returns the parameters of the block with these values. All others have their neutral value or, if there
  /// is none, their default value.
  [[nodiscard]] static Values start(std::initializer_list<Value> given) {
    Values values;
    for (const model::ParameterSpec& spec : Block<double>::parameters)
      values.push_back(spec.neutral == spec.neutral ? spec.neutral : spec.default_value);
    for (const Value& value : given) values[value.parameter.index] = value.value;
    return values;
  }

  /// Returns start points for all combinations of these values. The last axis varies fastest.
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
