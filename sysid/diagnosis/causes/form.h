#pragma once
// What a cause's file says, and the helpers to say it by parameter name. docs/how-to/add-a-cause.md shows
// one.
//
// A cause is a struct in a file of its own. One with a single form is that form; one with several lists them
// as `using Forms = List<...>`. The first form's block gives the cause its id, title and station; a
// cause whose id is another says `id` and `title` itself.
//
// A form is a struct derived from FormOf<a block>:
//   static Starts starts(const Scales&);                   from where fits begin; at least one
//   static Bounds bounds(const Scales&, const model::Model&);  beyond which the block would be something else
//                                                          by another name, and pass as a rival that is none
//   static constexpr std::array<Parameter, N> fitted{...}; what a fit moves; all parameters, where left out
//   static bool holds(const model::BlockSpec&);            where several forms share a block: whether it is
//                                                          this one
//   static constexpr bool free_form = true;                it can follow anything slow: named only where no
//                                                          law explains nearly as much
//
// A cause must say:
//   static constexpr WhenChanged when_changed{words, {step, step}, {{{number, way}, ...}}, size};
//                                                          for who stands beside the rig that it has come
//                                                          upon; the numbers of a recorded grip that it
//                                                          moves (health_sign.h), and by what its size is
//                                                          told (SizedBy), which may be left out
//
// A cause may say, besides:
//   static constexpr Column needs = ...;                   a column without which nothing can be told
//   static constexpr std::array advice{Advice::...};       what tells it from others where no waveform does
//   static constexpr std::string_view twin = "...";        gives the same readings whatever the command
//   static constexpr std::array<std::string_view, N> counterparts{...};
//       what the sensor may be instead of the actuator or the load, or the reverse, as asked
//   static constexpr std::array<std::string_view, N> confounded_with{...};
//       where one of these may be there too, the number is less certain than its fit says
//   static constexpr bool is_stop = true;                  holds the readings back at a place
//   static constexpr bool parts_twins = true;
//       remembers, between actuator and sensor: twins before it and behind it differ
//   static constexpr bool is_ideal = true;
//       no mechanism is quite like it: among causes that tie and have as many numbers, the other one is named
//   static constexpr std::string_view sensor_shape = "...";
//       a sensor without memory, in words: a gauge shows it
//   static constexpr Appears appears = ...;
//       where its effect must appear (evidence/signature.h)
//   static constexpr bool found_by_fitting = false;
//       no trajectory shows it: it has no starts

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

/// What somebody can do to tell causes apart that no waveform does. Two causes that share one are told apart
/// by it.
enum class Advice : std::uint8_t {
  change_load,         ///< change the load, move the object, or hold the sensor against a gauge
  leave_vented,        ///< leave the finger vented for an hour and read its zero
  record_temperature,  ///< record the temperature
  vary_temperature,    ///< the same, and that whatever the other cause is
};

/// What somebody checks of a change, and how it follows from what was fitted.
struct SizedBy {
  enum class Of : std::uint8_t {
    full_pressure,  ///< what it does at the highest pressures
    span,           ///< the same, as a share of all that the finger does
    largest,        ///< the most it does, with its sign
    amplitude,      ///< without
    number,         ///< a number of the block as it is
  };
  Of of = Of::full_pressure;
  std::string_view what = "at full pressure";
  std::string_view unit{};    ///< empty: the reading's
  std::string_view number{};  ///< by name; a form that has none of that name: full_pressure
  double factor = 1;
};

/// For who stands beside a rig whose finger has got the cause since it was healthy. Empty: it is none that
/// comes.
struct WhenChanged {
  std::string_view words;                      ///< "the finger rings"
  std::array<std::string_view, 2> next_steps;  ///< what a person can do about it, the quicker first
  HealthSigns signs{};                         ///< how recorded grips show it; none: they do not
  SizedBy size{};                              ///< what it is measured by
};

/// Between what a value may be.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// Forms of a cause, causes of the registry.
template <class... T>
struct List {};

/// What all forms have; Block is the class template of the block.
template <template <class> class Block>
struct FormOf {
  using BlockType = Block<double>;
  static constexpr std::string_view id = BlockType::info.id;

  /// A parameter of the block by its name: one that the block does not have is an error of the compiler.
  struct Parameter {
    std::size_t index;
    // NOLINTNEXTLINE(google-explicit-constructor): so that a name can be written where a parameter is meant.
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

  /// The block with these values; the others do nothing or, where they cannot, are typical.
  [[nodiscard]] static Values start(std::initializer_list<Value> given) {
    Values values;
    for (const model::ParameterSpec& spec : Block<double>::parameters)
      values.push_back(spec.neutral == spec.neutral ? spec.neutral : spec.default_value);
    for (const Value& value : given) values[value.parameter.index] = value.value;
    return values;
  }

  /// Every combination of these values, the last named varying fastest.
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
