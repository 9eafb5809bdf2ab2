#include "sysid/changes/downstream.h"

#include <algorithm>
#include <type_traits>

#include "model/catalogue.h"
#include "model/chain_walk.h"
#include "model/visit.h"
#include "sysid/fitting/trajectory_walk.h"

namespace softgrip::sysid {
namespace {

using model::Kind;
using Block = model::AnyBlock<double>;

template <class Any>
constexpr Kind kind_of = std::remove_cvref_t<Any>::info.kind;

double rested(Block& any, double input_mm) {
  double output_mm = input_mm;
  model::visit_block(any, [&](auto& block) {
    block.reset(input_mm);
    output_mm = block.output();
  });
  return output_mm;
}

double stepped(Block& any, const model::Segment<double>& in, const model::Surroundings& around) {
  double output_mm = in.end;
  model::visit_block(any, [&](auto& block) {
    if constexpr (kind_of<decltype(block)> == Kind::displacement) {
      block.step(in, around, [&](const model::Segment<double>& out) { output_mm = out.end; });
    } else if constexpr (kind_of<decltype(block)> == Kind::reading) {
      output_mm = block.sample(in.end, in.duration_s, around);
    }
  });
  return output_mm;
}

}  // namespace

bool is_downstream(const std::vector<model::BlockSpec>& blocks, const model::Model& base,
                   const Record& record) {
  if (record.held || record.start_unknown || base.blocks.empty()) return false;
  std::size_t before = base.blocks.back().type;
  return std::all_of(blocks.begin(), blocks.end(), [&](const model::BlockSpec& block) {
    const bool behind = block.type > before;
    before = block.type;
    return behind && model::catalogue()[block.type].at_samples;
  });
}

std::vector<double> downstream(const std::vector<model::BlockSpec>& blocks, const Record& record,
                               std::vector<double> base_mm) {
  for (const model::BlockSpec& spec : blocks) {
    Block block = model::walk::make_block<double>(spec.type, spec.values, {record.sample_time_s, 0});
    double last_mm = base_mm.front();
    base_mm.front() = rested(block, last_mm);
    for (std::size_t i = 1; i < base_mm.size(); ++i) {
      const double now_mm = base_mm[i];
      const auto in = model::Segment<double>::straight(record.duration_s[i], last_mm, now_mm);
      base_mm[i] = stepped(block, in, surroundings_at(record, i));
      last_mm = now_mm;
    }
  }
  return base_mm;
}

}  // namespace softgrip::sysid
