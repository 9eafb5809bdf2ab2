#pragma once
// Functions for tests that apply inputs to single blocks and to whole chains.

#include <span>
#include <vector>

#include "model/block.h"
#include "model/segment.h"

namespace softgrip::model::testing {

/// Creates a block from the list of its parameter values.
template <class Block>
Block make(std::initializer_list<double> values, double sample_time_s = 0) {
  const std::vector<double> list(values);
  return Block(std::span<const double>(list), Preparation{sample_time_s, 1});
}

/// Applies one input segment to a pressure or displacement block. Returns the output segments.
template <class Block>
std::vector<Segment<double>> pass(Block& block, const Segment<double>& in, const Surroundings& around = {}) {
  std::vector<Segment<double>> out;
  block.step(in, around, [&](const Segment<double>& s) { out.push_back(s); });
  return out;
}

/// Applies linear segments of length dt to a pressure or displacement block. The segments connect the value
/// `from` and then the elements of `values`. Returns the output of the block at the end of each segment.
template <class Block>
std::vector<double> drive(Block& block, double from, std::span<const double> values, double dt) {
  std::vector<double> out;
  for (const double value : values) {
    pass(block, Segment<double>::straight(dt, from, value));
    from = value;
    out.push_back(block.output());
  }
  return out;
}

/// Applies a linear segment from `from` to `to` [kPa] of duration dt [s] to an element. Then sets `from` to
/// `to`. Returns the output of the element at the end of the segment.
template <class Block>
double move(Block& element, double& from, double to, double dt) {
  element.step(Segment<double>::straight(dt, from, to), {});
  from = to;
  return element.output();
}

}  // namespace softgrip::model::testing
