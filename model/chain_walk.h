#pragma once
// Implements the functions of a Chain. Only files that instantiate Chain for a number type, or that construct
// a single block, include this file. chain.cpp instantiates Chain<double>.

#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

#include "model/chain.h"

namespace softgrip::model {

/// Calls function(block) with the block that `any` contains. The function finds the type of the block by
/// comparisons. It does not use std::visit. For more than eleven alternatives, std::visit uses a table of
/// function pointers, which prevents inlining. With std::visit, a call of Chain::peek() with the derivative
/// takes 33 ns in place of 14 ns.
template <class Any, class Function>
inline void visit_block(Any& any, Function&& function) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (void)((any.index() == I && (function(*std::get_if<I>(&any)), true)) || ...);
  }
  (std::make_index_sequence<std::variant_size_v<std::remove_const_t<Any>>>{});
}

namespace walk {

template <class T, std::size_t I = 0>
AnyBlock<T> make_block(std::size_t type, std::span<const T> values, const Preparation& preparation) {
  if constexpr (I + 1 < std::variant_size_v<AnyBlock<T>>) {
    if (type != I) return make_block<T, I + 1>(type, values, preparation);
  }
  return AnyBlock<T>(std::in_place_index<I>, values, preparation);
}

// Returns the seed of a block's random numbers. The seed depends on the id of the block, and on the number of
// earlier blocks with this id. Therefore, the seed does not change if blocks with different ids are added or
// removed.
inline std::uint64_t seed_of(const Model& model, std::size_t index, std::uint64_t seed) {
  std::uint64_t part = 0;
  for (const char c : catalogue()[model.blocks[index].type].info.id) {
    part = part * 131 + static_cast<unsigned char>(c);
  }
  for (std::size_t i = 0; i < index; ++i) part += model.blocks[i].type == model.blocks[index].type ? 1U : 0U;
  return derived_seed(seed, part);
}

template <class Block>
inline constexpr Kind kind_of = std::remove_cvref_t<Block>::info.kind;
/// Largest pressure change of one segment at the elements [kPa]. The limit applies to chains that have a
/// displacement block without an inverse, such as inertia. Such a block approximates the sum of the elements
/// by one parabola per segment. Therefore, a segment whose pressure change exceeds the limit is divided into
/// parts. For a change of 44 kPa within 10 ms and an inertia with a period of 45 ms, the error is 1e-4 mm. If
/// the segment is not divided, the error is 0.07 mm.
inline constexpr double longest_way_kpa = 5;
/// Largest number of parts into which a segment is divided. If this number of parts is reached, a part may
/// exceed longest_way_kpa.
inline constexpr double most_parts = 100;

template <class Block>
inline constexpr bool is_implicit = std::remove_cvref_t<Block>::info.inverse == Inverse::implicit;

}  // namespace walk

template <class T>
Chain<T>::Chain(const Model& model, std::span<const T> values, double sample_time_s, std::uint64_t seed)
    : sample_time_s_(sample_time_s) {
  blocks_.reserve(model.blocks.size());
  std::vector<T> own;
  std::size_t next = 0;
  for (const BlockSpec& spec : model.blocks) {
    const std::size_t count = spec.values.size();
    std::span<const T> block_values;
    if (values.empty()) {
      own.clear();
      for (const double value : spec.values) own.push_back(T(value));
      block_values = own;
    } else {
      block_values = values.subspan(next, count);
    }
    next += count;
    const Preparation preparation{sample_time_s, walk::seed_of(model, blocks_.size(), seed)};
    blocks_.push_back(walk::make_block<T>(spec.type, block_values, preparation));
    const BlockInfo& info = catalogue()[spec.type].info;
    const std::size_t behind = blocks_.size();
    for (auto s = static_cast<std::size_t>(info.station); s < end_.size(); ++s) end_[s] = behind;
    if (info.kind <= Kind::pressure) first_element_ = behind;
    if (info.kind <= Kind::element) first_displacement_ = behind;
    if (info.kind <= Kind::displacement) first_reading_ = behind;
    leaps_in_parts_ |= info.kind == Kind::displacement && info.inverse == Inverse::ignored;
  }
  // A block that has the function shape() modifies the chain's Bouc-Wen element.
  for (const AnyBlock<T>& any : blocks_) {
    visit_block(any, [&](const auto& block) {
      if constexpr (requires(BoucWen<T> & hysteresis) { block.shape(hysteresis); }) {
        for (AnyBlock<T>& other : blocks_) {
          if (BoucWen<T>* const hysteresis = std::get_if<BoucWen<T>>(&other)) block.shape(*hysteresis);
        }
      }
    });
  }
  reset(T(0.0));
}

template <class T>
Chain<T>::Chain(const Chain& other) = default;
template <class T>
Chain<T>::Chain(Chain&& other) noexcept = default;
template <class T>
Chain<T>& Chain<T>::operator=(const Chain& other) = default;
template <class T>
Chain<T>& Chain<T>::operator=(Chain&& other) noexcept = default;
template <class T>
Chain<T>::~Chain() = default;

template <class T>
void Chain<T>::reset(const T& command) {
  settle<false>(command);
}

template <class T>
void Chain<T>::rest(const T& command) {
  settle<true>(command);
}

template <class T>
template <bool campaign_goes_on>
void Chain<T>::settle(const T& command) {
  command_kpa_ = command;
  if constexpr (!campaign_goes_on) clock_s_ = 0;
  T pressure = command;
  T displacement(0.0);
  if (end_[0] == 0) after_[0] = pressure;
  for (Index i = 0; i < blocks_.size(); ++i) {
    visit_block(blocks_[i], [&](auto& block) {
      using Block = decltype(block);
      const auto to_rest = [&](const T& input) {
        if constexpr (campaign_goes_on && requires { block.rest(input); }) {
          block.rest(input);
        } else {
          block.reset(input);
        }
      };
      if constexpr (walk::kind_of<Block> == Kind::pressure) {
        to_rest(pressure);
        pressure = block.output();
      } else if constexpr (walk::kind_of<Block> == Kind::element) {
        to_rest(pressure);
        displacement += block.output();
      } else {
        to_rest(displacement);
        displacement = block.output();
      }
    });
    if (i + 1 == end_[0]) after_[0] = pressure;
    if (i + 1 >= first_displacement_ && i + 1 <= first_reading_) note_displacement(i + 1, displacement);
  }
  after_[3] = displacement;
}

template <class T>
T Chain<T>::step(const T& duration_s, const T& command, Surroundings surroundings) {
  T duration = duration_s;
  if constexpr (std::is_arithmetic_v<T>) {
    if (std::abs(duration - sample_time_s_) <= 1e-9 * sample_time_s_) duration = sample_time_s_;
  }
  clock_s_ += value_of(duration);
  if (std::isnan(surroundings.time_s)) surroundings.time_s = clock_s_;
  const Segment<T> segment = Segment<T>::straight(duration, command_kpa_, command);
  command_kpa_ = command;
  walk_pressure(0, segment, surroundings);
  walk_readings(duration, surroundings);
  return after_[3];
}

template <class T>
void Chain<T>::walk_pressure(Index i, const Segment<T>& segment, const Surroundings& surroundings) {
  if (i == end_[0]) after_[0] = segment.end;
  if (i == first_element_) {
    walk_elements(segment, surroundings);
    return;
  }
  visit_block(blocks_[i], [&](auto& block) {
    if constexpr (walk::kind_of<decltype(block)> == Kind::pressure) {
      block.step(segment, surroundings,
                 [&](const Segment<T>& out) { walk_pressure(i + 1, out, surroundings); });
    }
  });
}

template <class T>
void Chain<T>::walk_elements(const Segment<T>& segment, const Surroundings& surroundings) {
  if (leaps_in_parts_) {
    const double way_kpa = std::abs(value_of(segment.end) - value_of(segment.begin));
    if (way_kpa > walk::longest_way_kpa && value_of(segment.duration_s) > 0) {
      Segment<T> rest = segment;
      const double wanted = std::ceil(way_kpa / walk::longest_way_kpa);
      for (auto parts = static_cast<int>(std::fmin(wanted, walk::most_parts)); parts > 1; --parts) {
        const T share(1.0 / parts);
        add_elements(rest.before(share), surroundings);
        rest = rest.beyond(share);
      }
      add_elements(rest, surroundings);
      return;
    }
  }
  add_elements(segment, surroundings);
}

// The code of each block is always inlined, in this function and in peek(). By default, GCC 12 does not
// inline the code of Kelvin-Voigt. A call of peek() with the derivative then takes 41 ns in place of 17 ns.
template <class T>
void Chain<T>::add_elements(const Segment<T>& segment, const Surroundings& surroundings) {
  Segment<T> sum{segment.duration_s, T(0.0), T(0.0), T(0.0)};
  for (Index i = first_element_; i < first_displacement_; ++i) {
    visit_block(
        blocks_[i], [&](auto& block) __attribute__((always_inline)) {
          if constexpr (walk::kind_of<decltype(block)> == Kind::element) {
            const Segment<T> out = block.step(segment, surroundings);
            sum.begin += out.begin;
            sum.end += out.end;
            sum.mean += out.mean;
          }
        });
  }
  walk_displacement(first_displacement_, sum, surroundings);
}

template <class T>
void Chain<T>::walk_displacement(Index i, const Segment<T>& segment, const Surroundings& surroundings) {
  note_displacement(i, segment.end);
  if (i == first_reading_) return;
  visit_block(blocks_[i], [&](auto& block) {
    if constexpr (walk::kind_of<decltype(block)> == Kind::displacement) {
      block.step(segment, surroundings,
                 [&](const Segment<T>& out) { walk_displacement(i + 1, out, surroundings); });
    }
  });
}

template <class T>
void Chain<T>::walk_readings(const T& duration_s, const Surroundings& surroundings) {
  T value = at_sensor_;
  for (Index i = first_reading_; i < blocks_.size(); ++i) {
    visit_block(blocks_[i], [&](auto& block) {
      if constexpr (walk::kind_of<decltype(block)> == Kind::reading) {
        value = block.sample(value, duration_s, surroundings);
      }
    });
  }
  after_[3] = value;
}

template <class T>
template <class U>
U Chain<T>::peek(const T& duration_s, const U& end_kpa, Surroundings surroundings) const {
  if (std::isnan(surroundings.time_s)) surroundings.time_s = clock_s_ + value_of(duration_s);
  U pressure = end_kpa;
  U displacement(0.0);
  for (Index i = 0; i < end_[2]; ++i) {
    visit_block(
        blocks_[i], [&](const auto& block) __attribute__((always_inline)) {
          using Block = decltype(block);
          if constexpr (walk::is_implicit<Block>) {
            if constexpr (walk::kind_of<Block> == Kind::pressure) {
              pressure = block.peek(duration_s, pressure, surroundings);
            } else if constexpr (walk::kind_of<Block> == Kind::element) {
              displacement = displacement + block.peek(duration_s, pressure, surroundings);
            } else {
              displacement = block.peek(duration_s, displacement, surroundings);
            }
          }
        });
  }
  return displacement;
}

}  // namespace softgrip::model
