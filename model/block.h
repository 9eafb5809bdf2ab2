#pragma once
// What every block of a chain provides. One block, one file under model/blocks/, one line in registry.h.
//
// A block is a class template over the number type T (double; an automatic differentiation type):
//
//   template <class T> class ValveLag {
//    public:
//     static constexpr BlockInfo info{...};                      // id, station, kind, inverse, one line
//     static constexpr std::array parameters{ParameterSpec{...}}; // its only declaration
//     explicit ValveLag(std::span<const T> values, const Preparation&);
//     void reset(const T& input);         // at rest: as if `input` had been there for ever
//     T output() const;                   // where the block stands (displacement of an element, mm)
//     template <class Next> void step(const Segment<T>& in, const Surroundings&, Next&& next);
//   };
//
// step() calls next(segment) one or more times; the durations of what it passes on sum to the duration of
// what it got, the first `begin` is the last `end` of the step before, and each segment is monotone: a block
// whose output turns inside a sample passes two. With its effect at zero a block passes on what it got
// (the zero-limit), or, as an element, adds nothing.
// Blocks are copyable values; stepping allocates nothing once a block was prepared for a sample time.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "model/parameter.h"
#include "model/segment.h"

namespace softgrip::model {

/// Where a block stands. A chain's blocks are ordered by station; inside one, as the model file lists them,
/// but by kind in the actuator: pressure blocks, then elements, then displacement blocks.
enum class Station : std::uint8_t { valve, actuator, load, sensor };

/// What a block does to the signal that walks the chain.
enum class Kind : std::uint8_t {
  pressure,      ///< kPa in, kPa out, in series
  element,       ///< kPa in, mm out; all elements of a chain see the same pressure and their outputs add
  displacement,  ///< mm in, mm out, in series
};

/// How the control side undoes a block.
enum class Inverse : std::uint8_t {
  implicit,  ///< solved together with the actuator: output monotone in the newest pressure
  lead,      ///< the derivative of the planned pressure
  preview,   ///< asking for the future value of the reference
  bound,     ///< no inverse: bounds the reference
  ignored,   ///< not to be inverted (noise, quantisation)
};

/// What a block says of itself.
struct BlockInfo {
  std::string_view id;     ///< YAML key, cause id
  Station station;
  Kind kind;
  Inverse inverse;
  std::string_view title;  ///< "Transport delay"
  std::string_view meaning;  ///< one line for the manual
};

/// What a block may need to prepare itself, besides its parameters.
struct Preparation {
  double sample_time_s = 0;  ///< nominal; 0 when samples are irregular
  std::uint64_t seed = 0;    ///< of this block's random numbers, distinct per block and channel
};

/// "valve", "actuator", "load", "sensor"
[[nodiscard]] constexpr std::string_view name_of(Station station) {
  constexpr std::array<std::string_view, 4> names{"valve", "actuator", "load", "sensor"};
  return names[static_cast<std::size_t>(station)];
}

}  // namespace softgrip::model
