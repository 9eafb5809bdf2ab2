#include "drivers/modbus/exchange_plan.h"

#include <modbus/modbus.h>

#include <algorithm>

#include "drivers/modbus/modbus_message.h"

namespace softgrip::drivers {
namespace {

/// A range of registers (or bits) from `begin` to `end` (not included) that is read with one function code.
struct Range {
  std::uint8_t function = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

bool is_bits(std::uint8_t function) {
  return function <= MODBUS_FC_READ_DISCRETE_INPUTS;
}

std::uint32_t most_readable(const BoardMap& map, std::uint8_t function) {
  return is_bits(function) ? max_read_bits : std::min(max_read_registers, map.max_registers);
}

/// Adds ranges that contain the numbers `indices` of a block, and as few ranges as possible. No number is
/// divided between two ranges. A range may include numbers that are not in `indices`, because the board can
/// read all registers of the block.
void cover(const BoardMap& map, const RegisterBlock& block, std::vector<std::size_t> indices,
           std::vector<Range>& ranges) {
  std::sort(indices.begin(), indices.end());
  const std::uint32_t most = most_readable(map, block.function);
  std::optional<Range> open;
  for (const std::size_t index : indices) {
    const std::uint32_t begin = block.address_of(index);
    const std::uint32_t end = begin + words_of(block.kind);
    if (open && end - open->begin > most) {
      ranges.push_back(*open);
      open.reset();
    }
    if (!open) open = Range{block.function, begin, end};
    open->end = end;
  }
  if (open) ranges.push_back(*open);
}

/// Returns the number of registers in [begin, end) that are in no register block that `function` can read.
std::uint32_t undeclared(const BoardMap& map, std::uint8_t function, std::uint32_t begin, std::uint32_t end) {
  std::vector<RegisterBlock> blocks;
  if (map.has_inputs()) blocks.push_back(map.inputs.registers);
  if (map.input_status.has_value()) blocks.push_back(map.input_status->registers);
  if (map.read_back.has_value()) blocks.push_back(map.read_back->registers);
  std::uint32_t count = 0;
  for (std::uint32_t address = begin; address < end; ++address) {
    const bool declared = std::any_of(blocks.begin(), blocks.end(), [&](const RegisterBlock& block) {
      return block.function == function && address >= block.address &&
             address < static_cast<std::uint32_t>(block.address) + block.registers();
    });
    if (!declared) ++count;
  }
  return count;
}

std::vector<ReadStep> merged(const BoardMap& map, std::vector<Range> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) {
    return a.function != b.function ? a.function < b.function : a.begin < b.begin;
  });
  std::vector<Range> result;
  for (const Range& range : ranges) {
    if (!result.empty() && result.back().function == range.function) {
      Range& last = result.back();
      const std::uint32_t end = std::max(last.end, range.end);
      const bool gap_allowed = range.begin <= last.end ||
                               undeclared(map, range.function, last.end, range.begin) <= map.readable_gap;
      if (gap_allowed && end - last.begin <= most_readable(map, range.function)) {
        last.end = end;
        continue;
      }
    }
    result.push_back(range);
  }
  std::vector<ReadStep> steps;
  steps.reserve(result.size());
  for (const Range& range : result) {
    steps.push_back({range.function, static_cast<std::uint16_t>(range.begin),
                     static_cast<std::uint16_t>(range.end - range.begin)});
  }
  return steps;
}

std::vector<std::size_t> wired_inputs(const std::vector<ChannelWiring>& wiring, std::size_t module) {
  std::vector<std::size_t> inputs;
  for (const ChannelWiring& channel : wiring) {
    if (channel.displacement.module == module) inputs.push_back(channel.displacement.input);
    if (channel.pressure.has_value() && channel.pressure->module == module) {
      inputs.push_back(channel.pressure->input);
    }
    const auto& temperature = channel.temperature;
    if (temperature.has_value() && temperature->module == module &&
        std::find(inputs.begin(), inputs.end(), temperature->input) == inputs.end()) {
      inputs.push_back(temperature->input);
    }
  }
  return inputs;
}

std::vector<std::size_t> wired_outputs(const std::vector<ChannelWiring>& wiring, std::size_t module) {
  std::vector<std::size_t> outputs;
  for (const ChannelWiring& channel : wiring) {
    if (channel.valve.module == module) outputs.push_back(channel.valve.output);
  }
  return outputs;
}

/// Returns the reads of one exchange. The reads contain the wired inputs. If the module has wired outputs,
/// the reads also contain the registers for read-back, watchdog and number of clients.
std::vector<ReadStep> plan_reads(const BoardMap& map, const std::vector<std::size_t>& inputs,
                                 const std::vector<std::size_t>& outputs) {
  std::vector<Range> ranges;
  if (!inputs.empty()) {
    cover(map, map.inputs.registers, inputs, ranges);
    if (map.input_status.has_value()) cover(map, map.input_status->registers, inputs, ranges);
  }
  if (!outputs.empty()) {
    if (map.read_back.has_value()) cover(map, map.read_back->registers, outputs, ranges);
    if (map.watchdog.tripped.has_value()) {
      const BoardWatchdog::Tripped& tripped = *map.watchdog.tripped;
      ranges.push_back(
          {tripped.function, tripped.address, static_cast<std::uint32_t>(tripped.address) + tripped.count});
    }
    if (const auto& clients = map.watchdog.clients) {
      ranges.push_back(
          {clients->function, clients->address, static_cast<std::uint32_t>(clients->address) + 1});
    }
  }
  return merged(map, std::move(ranges));
}

/// Plans one write for each group of adjacent wired outputs. The registers of the outputs are in the order of
/// the terminals.
void plan_writes(const BoardMap& map, const std::vector<ChannelWiring>& wiring, std::size_t module,
                 ExchangePlan& plan) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < wiring.size(); ++i) {
    if (wiring[i].valve.module == module) order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return wiring[a].valve.output < wiring[b].valve.output; });
  const RegisterBlock& block = map.outputs.registers;
  const std::uint16_t words = words_of(block.kind);
  const std::uint16_t most =
      std::min(map.max_registers, map.has_fc23 ? max_fc23_write_registers : max_write_registers);
  for (const std::size_t channel : order) {
    const std::uint32_t address = block.address_of(wiring[channel].valve.output);
    plan.channels[channel].output_word = plan.output_words;
    const bool continues = !plan.writes.empty() && block.function == MODBUS_FC_WRITE_MULTIPLE_REGISTERS &&
                           plan.writes.back().address + plan.writes.back().count == address &&
                           plan.writes.back().count + words <= most;
    if (continues) {
      plan.writes.back().count = static_cast<std::uint16_t>(plan.writes.back().count + words);
    } else {
      plan.writes.push_back({block.function, static_cast<std::uint16_t>(address), words, plan.output_words});
    }
    plan.output_words += words;
  }
}

Slot slot_of(const std::vector<ReadStep>& reads, std::uint8_t function, std::uint32_t address) {
  for (std::size_t step = 0; step < reads.size(); ++step) {
    const ReadStep& read = reads[step];
    if (read.function == function && address >= read.address && address < read.address + read.count) {
      return {step, static_cast<std::size_t>(address - read.address)};
    }
  }
  return {};
}

}  // namespace

ExchangePlan plan_exchange(const BoardMap& map, const std::vector<ChannelWiring>& wiring,
                           std::size_t module) {
  ExchangePlan plan;
  plan.channels.resize(wiring.size());
  if (wiring.empty()) return plan;
  const std::vector<std::size_t> inputs = wired_inputs(wiring, module);
  const std::vector<std::size_t> outputs = wired_outputs(wiring, module);
  plan_writes(map, wiring, module, plan);
  plan.reads = plan_reads(map, inputs, outputs);

  const auto slot = [&](const RegisterBlock& block, std::size_t index) {
    return slot_of(plan.reads, block.function, block.address_of(index));
  };
  const auto place_input = [&](const InputWiring& input, std::optional<Slot>& value,
                               std::optional<Slot>& status) {
    if (input.module != module) return;
    value = slot(map.inputs.registers, input.input);
    if (map.input_status.has_value()) status = slot(map.input_status->registers, input.input);
  };
  for (std::size_t i = 0; i < wiring.size(); ++i) {
    const ChannelWiring& channel = wiring[i];
    ChannelSlots& slots = plan.channels[i];
    place_input(channel.displacement, slots.displacement, slots.displacement_status);
    if (channel.pressure.has_value()) place_input(*channel.pressure, slots.pressure, slots.pressure_status);
    if (channel.temperature.has_value())
      place_input(*channel.temperature, slots.temperature, slots.temperature_status);
    if (map.read_back.has_value() && channel.valve.module == module) {
      slots.read_back = slot(map.read_back->registers, channel.valve.output);
    }
  }
  if (map.watchdog.tripped.has_value() && !outputs.empty()) {
    plan.tripped = slot_of(plan.reads, map.watchdog.tripped->function, map.watchdog.tripped->address);
  }
  if (map.watchdog.clients.has_value() && !outputs.empty()) {
    plan.clients = slot_of(plan.reads, map.watchdog.clients->function, map.watchdog.clients->address);
  }
  if (!inputs.empty()) plan.sampling_read = slot(map.inputs.registers, inputs.front()).step;
  if (map.has_fc23 && !inputs.empty() && !outputs.empty()) plan.combined_read = plan.sampling_read;
  return plan;
}

std::string describe(const ExchangePlan& plan) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  for (std::size_t i = 0; i < plan.writes.size(); ++i) {
    const WriteStep& write = plan.writes[i];
    const bool combined = i == 0 && plan.combined_read.has_value();
    std::string part = "FC" + std::to_string(combined ? MODBUS_FC_WRITE_AND_READ_REGISTERS : write.function) +
                       " writes " + std::to_string(write.count) + " from " + std::to_string(write.address);
    if (combined) {
      const ReadStep& read = plan.reads[*plan.combined_read];
      part += " and reads " + std::to_string(read.count) + " from " + std::to_string(read.address);
    }
    add(part);
  }
  for (std::size_t i = 0; i < plan.reads.size(); ++i) {
    if (plan.combined_read == i) continue;
    const ReadStep& read = plan.reads[i];
    add("FC" + std::to_string(read.function) + " reads " + std::to_string(read.count) + " from " +
        std::to_string(read.address));
  }
  return text;
}

}  // namespace softgrip::drivers
