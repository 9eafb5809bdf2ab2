#pragma once
// Driving single blocks and whole chains from tests.

#include <cmath>
#include <span>
#include <vector>

#include "model/block.h"
#include "model/segment.h"

namespace softgrip::model::testing {

/// A block from a list of its values.
template <class Block>
Block make(std::initializer_list<double> values, double sample_time_s = 0) {
  const std::vector<double> list(values);
  return Block(std::span<const double>(list), Preparation{sample_time_s, 1});
}

/// What a pressure or displacement block passes on for one segment.
template <class Block>
std::vector<Segment<double>> pass(Block& block, const Segment<double>& in, const Surroundings& around = {}) {
  std::vector<Segment<double>> out;
  block.step(in, around, [&](const Segment<double>& s) { out.push_back(s); });
  return out;
}

/// Steps a pressure or displacement block along straight pieces of length dt through `values` (the first one
/// from `from`) and returns its output after each.
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

/// The same for an element.
template <class Block>
double move(Block& element, double& from, double to, double dt) {
  element.step(Segment<double>::straight(dt, from, to), {});
  from = to;
  return element.output();
}

}  // namespace softgrip::model::testing
