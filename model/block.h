#pragma once
// What every block of a chain provides. One mechanism, one block, one file under model/blocks/, one line in
// registry.h. docs/how-to/add-a-block.md goes through the steps.
//
// A block is a class template over the number type T (double; an automatic differentiation type):
//
//   template <class T> class ValveLag {
//    public:
//     static constexpr BlockInfo info = block_info(...);          // id, station, kind, inverse, one line
//     static constexpr std::array parameters{parameter(...)};     // its only declaration
//     ValveLag(std::span<const T> values, const Preparation&);
//     void reset(const T& input);  // see "Rest"
//     T output() const;            // where the block stands
//     ... and by kind:
//   };
//
//   pressure, displacement:
//     template <class Next> void step(const Segment<T>& in, const Surroundings&, Next&& next);
//   element:
//     Segment<T> step(const Segment<T>& in, const Surroundings&);
//   reading:
//     T sample(const T& displacement_mm, const T& duration_s, const Surroundings&);
//   whose info.inverse is Inverse::implicit, besides, without touching the state, from where the block
//   stands:
//     element:                 U peek(const T& duration_s, const U& end_kpa, const Surroundings&) const;
//     pressure, displacement:  U peek(const T& duration_s, const U& end, const Surroundings&) const;
//     (a template over U: double, or Dual<double> for the derivative with respect to the newest pressure)
//
// The concepts below are this contract for the compiler; registry.h asks them of every block.
//
// A step calls next(segment) one or more times; the durations of what it passes on sum to the duration of
// what it got (a jump may be kept back by a delay), the first `begin` is the last `end` of the step before,
// and a block whose output turns inside a sample passes two segments, so that Bouc-Wen sees the turn.
// With its parameters at their neutral values a block passes on what it got; an element adds nothing.
//
// Rest. reset(input) puts a block where it stands after its input rose from 0 to `input` once and has been
// held ever since: lags and creep settled, hysteresis on its first loading curve, the delay line filled.
//
// A block that remembers something for the whole campaign (the largest load so far) has rest(input) besides,
// which does the same but keeps that memory.
//
// A block with repeated parts declares `repeated` (the parameters of one part, in order) and `max_parts`
// besides, and `min_parts` if that is not one. A block whose parameters must fit each other declares
// `static std::string_view objection(std::span<const double> values)`, empty when they do.
//
// A displacement block whose output at the end of a sample follows from its input and its surroundings there,
// whatever the way to it was, declares `static constexpr bool at_samples = true`. Of reading blocks that is
// so anyway; those whose random numbers depend on their place in the chain declare it false.
//
// A block that is a part of the chain's Bouc-Wen hysteresis declares `void shape(BoucWen<T>&) const` besides,
// which the chain calls once when it is made.
//
// Blocks are copyable values; stepping allocates nothing once a block was prepared for a sample time.

#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>

#include "model/dual.h"
#include "model/parameter.h"
#include "model/segment.h"

namespace softgrip::model {

/// The station of a block in the chain. A chain's blocks are ordered by station and, inside a station, by
/// kind: pressure blocks, elements, displacement blocks, reading blocks. Equal blocks keep the order of the
/// model file.
enum class Station : std::uint8_t { valve, actuator, load, sensor };

/// The effect of a block on the signal in the chain.
enum class Kind : std::uint8_t {
  pressure,      ///< kPa in, kPa out, in series
  element,       ///< kPa in, mm out; all elements of a chain see the same pressure and their outputs add
  displacement,  ///< mm in, mm out, in series
  reading,       ///< mm in, mm out, once per step at its end: what a sensor does to the value that is read
};

/// How the control side undoes a block.
enum class Inverse : std::uint8_t {
  implicit,  ///< solved together with the actuator: output monotone in the newest pressure
  lead,      ///< the derivative of the planned signal
  preview,   ///< asking for the future value of the reference
  play,      ///< half the band in the direction of travel
  bound,     ///< no inverse: bounds the reference
  ignored,   ///< not to be inverted (noise, quantisation)
};

/// Description of a block type.
struct BlockInfo {
  std::string_view id;  ///< YAML key, cause id
  Station station;
  Kind kind;
  Inverse inverse;
  std::string_view title;     ///< "Transport delay"
  std::string_view meaning;   ///< one line for the manual
  std::string_view equation;  ///< what it computes, in plain text
  bool repeatable = false;    ///< may occur in a chain more than once (two stops, two disturbances)
};

/// For block_info(): the block may occur in a chain more than once.
struct Repeatable {};

/// Returns the description of a block, in the order of the members above. The meaning is a sentence.
consteval BlockInfo block_info(std::string_view id, Station station, Kind kind, Inverse inverse,
                               std::string_view title, std::string_view meaning, std::string_view equation) {
  if (id.empty() || title.empty() || !meaning.ends_with('.'))
    throw "a block has an id, a title and a meaning";
  return {id, station, kind, inverse, title, meaning, equation};
}
consteval BlockInfo block_info(std::string_view id, Station station, Kind kind, Inverse inverse,
                               std::string_view title, std::string_view meaning, std::string_view equation,
                               Repeatable) {
  BlockInfo info = block_info(id, station, kind, inverse, title, meaning, equation);
  info.repeatable = true;
  return info;
}

/// Inputs for the preparation of a block in addition to its parameters.
struct Preparation {
  double sample_time_s = 0;  ///< nominal; 0 when samples are irregular
  std::uint64_t seed = 0;    ///< of this block's random numbers, distinct per block and channel
};

/// It says what it is and which numbers it has.
template <class Block>
concept SaysWhatItIs = requires {
  { Block::info } -> std::same_as<const BlockInfo&>;
  std::span<const ParameterSpec>(Block::parameters);
};

/// With repeated parts it says what one of them has and how many there may be.
template <class Block>
concept SaysItsParts = requires {
  std::span<const ParameterSpec>(Block::repeated);
  std::size_t{Block::max_parts};
};

/// Requires a copyable value that is made from its parameters, has a rest state and returns its output.
template <class Block, class T>
concept StandsSomewhere = std::copyable<Block> &&
    requires(Block block, const Block& still, const T& input, std::span<const T> values,
             const Preparation& preparation) {
  Block(values, preparation);
  block.reset(input);
  { still.output() } -> std::convertible_to<T>;
};

/// Pressure and displacement blocks: it passes segments on.
template <class Block, class T>
concept PassesOn = requires(Block block, const Segment<T>& in, const Surroundings& around,
                            void (&next)(const Segment<T>&)) {
  { block.step(in, around, next) } -> std::same_as<void>;
};

/// Elements: it turns pressure into displacement.
template <class Block, class T>
concept TurnsIntoDisplacement = requires(Block block, const Segment<T>& in, const Surroundings& around) {
  { block.step(in, around) } -> std::same_as<Segment<T>>;
};

/// Reading blocks: it samples a displacement.
template <class Block, class T>
concept Samples = requires(Block block, const T& value, const Surroundings& around) {
  { block.sample(value, value, around) } -> std::same_as<T>;
};

/// Blocks that are undone implicitly: it says where it would go.
template <class Block, class T, class U>
concept Foretells = requires(const Block block, const T& duration_s, const U& end,
                             const Surroundings& around) {
  { block.peek(duration_s, end, around) } -> std::same_as<U>;
};

/// The contract by kind.
template <class Block, class T>
concept SeriesBlock = SaysWhatItIs<Block> && StandsSomewhere<Block, T> && PassesOn<Block, T>;
template <class Block, class T>
concept ElementBlock = SaysWhatItIs<Block> && StandsSomewhere<Block, T> && TurnsIntoDisplacement<Block, T>;
template <class Block, class T>
concept ReadingBlock = SaysWhatItIs<Block> && StandsSomewhere<Block, T> && Samples<Block, T>;

/// Compiles for a block that fulfils its contract; otherwise the compiler's message names the missing part.
template <template <class> class Block, class T>
consteval bool keeps_contract() {
  using B = Block<T>;
  static_assert(SaysWhatItIs<B>);
  if constexpr (requires { B::repeated; }) static_assert(SaysItsParts<B>);
  constexpr Kind kind = B::info.kind;
  if constexpr (kind == Kind::pressure || kind == Kind::displacement) static_assert(SeriesBlock<B, T>);
  if constexpr (kind == Kind::element) static_assert(ElementBlock<B, T>);
  if constexpr (kind == Kind::reading) static_assert(ReadingBlock<B, T>);
  if constexpr (B::info.inverse == Inverse::implicit) {
    static_assert(Foretells<B, T, T>);
    static_assert(Foretells<B, T, Dual<T>>);
  }
  return true;
}

/// "valve", "actuator", "load", "sensor"
[[nodiscard]] constexpr std::string_view name_of(Station station) {
  constexpr std::array<std::string_view, 4> names{"valve", "actuator", "load", "sensor"};
  return names[static_cast<std::size_t>(station)];
}

/// "pressure", "element", "displacement", "reading"
[[nodiscard]] constexpr std::string_view name_of(Kind kind) {
  constexpr std::array<std::string_view, 4> names{"pressure", "element", "displacement", "reading"};
  return names[static_cast<std::size_t>(kind)];
}

/// "implicit", "lead", "preview", "bound", "ignored"
[[nodiscard]] constexpr std::string_view name_of(Inverse inverse) {
  constexpr std::array<std::string_view, 5> names{"implicit", "lead", "preview", "bound", "ignored"};
  return names[static_cast<std::size_t>(inverse)];
}

}  // namespace softgrip::model
