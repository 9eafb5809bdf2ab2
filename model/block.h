#pragma once
// Defines the interface of a block of the chain. Each physical effect is one block, with one file under
// model/blocks/ and one line in registry.h. docs/how-to/add-a-block.md describes the steps.
//
// A block is a class template over the number type T, which is double or an automatic differentiation type:
//
//   template <class T> class ValveLag {
//    public:
//     static constexpr BlockInfo info = block_info(...);          // id, station, kind, inverse, texts
//                                       // Repeatable and Formerly are optional further arguments
//     static constexpr std::array parameters{parameter(...)};     // the only declaration of the parameters
//     ValveLag(std::span<const T> values, const Preparation&);
//     void reset(const T& input);  // see the paragraph "Rest"
//     T output() const;            // current output
//     ... and one of the following functions, depending on the kind of the block:
//   };
//
//   pressure, displacement:
//     template <class Next> void step(const Segment<T>& in, const Surroundings&, Next&& next);
//   element:
//     Segment<T> step(const Segment<T>& in, const Surroundings&);
//   reading:
//     T sample(const T& displacement_mm, const T& duration_s, const Surroundings&);
// If info.inverse is Inverse::implicit, a block also has a function that predicts its output from the current
// state and does not change the state:
//     element:                 U peek(const T& duration_s, const U& end_kpa, const Surroundings&) const;
//     pressure, displacement:  U peek(const T& duration_s, const U& end, const Surroundings&) const;
//     (a template over U: double, or Dual<double> for the derivative with respect to the newest pressure)
//
// The concepts in this file state these requirements for the compiler. registry.h checks every block against
// the concepts.
//
// A step calls next(segment) one or more times to pass segments on. The sum of the durations of these
// segments is the duration of the input segment. A delay may pass on a jump in a later step. The `begin` of
// the first segment equals the `end` of the last segment of the previous step. If the output of a block
// reverses within a sample, the block passes two segments on, so that the Bouc-Wen block receives the
// reversal. With its neutral parameter values, a block passes its input on unchanged, and an element adds 0
// mm.
//
// Rest. reset(input) sets a state of rest: the input rose from 0 to `input` once and was then held for a long
// time. In this state, lags and creep have settled, hysteresis is on its first loading curve, and the delay
// line is filled.
//
// A block with a memory over the whole measurement campaign, such as the largest load so far, also has
// rest(input). rest(input) sets the same state as reset(input), but keeps the memory over the campaign.
//
// A block with repeated parts also declares `repeated` (the parameters of one part, in order) and
// `max_parts`. If the smallest number of parts is not 1, the block also declares `min_parts`. A block whose
// parameters depend on each other declares `static std::string_view objection(std::span<const double>
// values)`. This function returns an empty text for valid values.
//
// For some displacement blocks, the output at the end of a sample depends only on the input and the
// surroundings at that time. Such a block declares `static constexpr bool at_samples = true`. For reading
// blocks, `at_samples` is true by default. Reading blocks with random numbers declare `at_samples = false`.
//
// A block that modifies the chain's Bouc-Wen element also declares `void shape(BoucWen<T>&) const`. The
// constructor of the chain calls this function once.
//
// Blocks are copyable. The steps of a block allocate no memory if the block was constructed for a sample
// time.

#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "model/dual.h"
#include "model/parameter.h"
#include "model/segment.h"

namespace softgrip::model {

/// The station of a block in the chain. The blocks of a chain are ordered by station. Within a station, the
/// order of the kinds is pressure blocks, elements, displacement blocks, reading blocks. Blocks of one
/// station and kind are in the order of the model file.
enum class Station : std::uint8_t { valve, actuator, load, sensor };

/// The kind of a block: its input and its output in the chain.
enum class Kind : std::uint8_t {
  pressure,      ///< pressure in, pressure out [kPa]; the blocks are in series
  element,       ///< pressure in [kPa], displacement out [mm]; all elements of a chain have the same input,
                 ///< and their outputs are added
  displacement,  ///< displacement in, displacement out [mm]; the blocks are in series
  reading,       ///< displacement in, reading out [mm]; an effect of the sensor, computed once at the end of
                 ///< each sample
};

/// The method by which the feedforward compensates the effect of a block.
enum class Inverse : std::uint8_t {
  implicit,  ///< the block is inverted together with the actuator; its output increases with the newest
             ///< pressure
  lead,      ///< inverted with the derivative of the planned signal
  preview,   ///< inverted with the future value of the reference
  play,      ///< inverted by adding half the width of the band in the direction of motion
  bound,     ///< not inverted; the block sets a limit for the reference
  none,      ///< not inverted, because an inverse may be unstable; feedforward `full_model` refuses the block
  ignored,   ///< not inverted, because the effect is random or small (noise, quantisation)
};

/// Description of a block type.
struct BlockInfo {
  std::string_view id;  ///< key of the block in model files, and id of the corresponding cause
  Station station;
  Kind kind;
  Inverse inverse;
  std::string_view title;     ///< title of the block, such as "Transport delay"
  std::string_view meaning;   ///< description of the block in one line for the reference page
  std::string_view equation;  ///< equation of the block as plain text
  bool repeatable = false;    ///< true: a chain may contain the block more than once (two stops, two
                              ///< disturbances)
  /// Deprecated id of the block, which is accepted wherever `id` is accepted; "" if there is none.
  std::string_view formerly = {};

  /// Returns true if `name` is the id or the deprecated id of the block.
  [[nodiscard]] constexpr bool is_named(std::string_view name) const {
    return name == id || (!formerly.empty() && name == formerly);
  }
};

/// Argument of block_info() for a block that a chain may contain more than once.
struct Repeatable {};

namespace declaration {
constexpr void add(BlockInfo& info, Repeatable) {
  info.repeatable = true;
}
constexpr void add(BlockInfo& info, Formerly formerly) {
  info.formerly = formerly.name;
}
}  // namespace declaration

/// Returns the description of a block. The arguments have the order of the members of BlockInfo. `meaning` is
/// a sentence. `more` can contain Repeatable{} and the deprecated id of the block, as
/// Formerly{"sensor_wander"}.
template <class... More>
consteval BlockInfo block_info(std::string_view id, Station station, Kind kind, Inverse inverse,
                               std::string_view title, std::string_view meaning, std::string_view equation,
                               More... more) {
  BlockInfo info{id, station, kind, inverse, title, meaning, equation};
  (declaration::add(info, more), ...);
  if (id.empty() || title.empty() || !meaning.ends_with('.'))
    throw "a block requires an id, a title and a meaning";
  if (info.formerly == id) throw "the deprecated id of a block must differ from its id";
  return info;
}

/// Data with which a block is constructed, in addition to its parameters.
struct Preparation {
  double sample_time_s = 0;  ///< nominal sample time [s]; 0: the times between samples are irregular
  std::uint64_t seed = 0;    ///< seed of the random numbers of this block; the seeds of any two blocks of any
                             ///< channels differ
};

/// A pressure or displacement block that consists of one part, such as a lag or a play. `Part` has the
/// functions reset(), output() and step(segment, next).
template <class T, class Part>
class OnePartBlock {
 public:
  void reset(const T& input) { part_.reset(input); }
  [[nodiscard]] T output() const { return part_.output(); }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    part_.step(in, next);
  }

 protected:
  explicit OnePartBlock(Part part) : part_(std::move(part)) {}

  Part part_;
};

/// Requires that the block has a description and a list of parameters.
template <class Block>
concept SaysWhatItIs = requires {
  { Block::info } -> std::same_as<const BlockInfo&>;
  std::span<const ParameterSpec>(Block::parameters);
};

/// Requires that a block with repeated parts declares the parameters of one part and the limits of the number
/// of parts.
template <class Block>
concept SaysItsParts = requires {
  std::span<const ParameterSpec>(Block::repeated);
  std::size_t{Block::max_parts};
};

/// Requires that a block is copyable, is constructed from its parameters, has a state of rest, and returns
/// its output.
template <class Block, class T>
concept StandsSomewhere = std::copyable<Block> &&
    requires(Block block, const Block& still, const T& input, std::span<const T> values,
             const Preparation& preparation) {
  Block(values, preparation);
  block.reset(input);
  { still.output() } -> std::convertible_to<T>;
};

/// Requires that step() of a pressure block or displacement block passes segments on.
template <class Block, class T>
concept PassesOn = requires(Block block, const Segment<T>& in, const Surroundings& around,
                            void (&next)(const Segment<T>&)) {
  { block.step(in, around, next) } -> std::same_as<void>;
};

/// Requires that step() of an element converts a pressure to a displacement.
template <class Block, class T>
concept TurnsIntoDisplacement = requires(Block block, const Segment<T>& in, const Surroundings& around) {
  { block.step(in, around) } -> std::same_as<Segment<T>>;
};

/// Requires that sample() of a sensor block converts a displacement to a reading.
template <class Block, class T>
concept Samples = requires(Block block, const T& value, const Surroundings& around) {
  { block.sample(value, value, around) } -> std::same_as<T>;
};

/// Requires that peek() predicts the output of a block that is inverted implicitly.
template <class Block, class T, class U>
concept Foretells = requires(const Block block, const T& duration_s, const U& end,
                             const Surroundings& around) {
  { block.peek(duration_s, end, around) } -> std::same_as<U>;
};

/// The next three concepts contain all requirements: of a block in series, of an element, and of a reading
/// block.
template <class Block, class T>
concept SeriesBlock = SaysWhatItIs<Block> && StandsSomewhere<Block, T> && PassesOn<Block, T>;
template <class Block, class T>
concept ElementBlock = SaysWhatItIs<Block> && StandsSomewhere<Block, T> && TurnsIntoDisplacement<Block, T>;
template <class Block, class T>
concept ReadingBlock = SaysWhatItIs<Block> && StandsSomewhere<Block, T> && Samples<Block, T>;

/// Compiles only for a block that meets all requirements of its kind. For any other block, the error message
/// of the compiler names the requirement that is not met.
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

/// Returns the name of a station: "valve", "actuator", "load" or "sensor".
[[nodiscard]] constexpr std::string_view name_of(Station station) {
  constexpr std::array<std::string_view, 4> names{"valve", "actuator", "load", "sensor"};
  return names[static_cast<std::size_t>(station)];
}

/// Returns the name of a kind: "pressure", "element", "displacement" or "reading".
[[nodiscard]] constexpr std::string_view name_of(Kind kind) {
  constexpr std::array<std::string_view, 4> names{"pressure", "element", "displacement", "reading"};
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace softgrip::model
