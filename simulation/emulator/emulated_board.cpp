#include "simulation/emulator/emulated_board.h"

#include <modbus/modbus.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/board/registers.h"

namespace softgrip::simulation {
namespace {

using drivers::BoardWatchdog;
using drivers::FixedWrite;
using drivers::RegisterBlock;

constexpr double nanoseconds_per_second = 1e9;

bool reads_input_registers(const RegisterBlock& block) {
  return block.function == MODBUS_FC_READ_INPUT_REGISTERS;
}

/// First register and number of registers that a write request changes. The number is 0 if the request
/// changes no register.
struct WrittenRange {
  std::size_t first = 0;
  std::size_t count = 0;
};
WrittenRange written_by(std::span<const std::uint8_t> pdu) {
  switch (pdu[0]) {
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      return {word_at(pdu, 1), 1};
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return {word_at(pdu, 1), word_at(pdu, 3)};
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return {word_at(pdu, 5), word_at(pdu, 7)};
    default:
      return {};
  }
}

}  // namespace

EmulatedBoard::EmulatedBoard(const drivers::BoardMap& map)
    : map_(map), outputs_(map.outputs.registers.count) {
  define_registers();
  go_safe();
  for (std::size_t i = 0; i < map_.inputs.registers.count; ++i) set_input(i, 0);
}

void EmulatedBoard::define_registers() {
  define_block(map_.inputs.registers, Registers::Access::read_only);
  if (map_.input_status) define_block(map_.input_status->registers, Registers::Access::read_only);
  if (map_.read_back) define_block(map_.read_back->registers, Registers::Access::read_only);
  for (const FixedWrite& write : map_.setup) define_write(write);
  if (map_.watchdog.feed_write) define_write(*map_.watchdog.feed_write);
  for (const FixedWrite& write : map_.watchdog.clear) define_write(write);
  if (const auto& flag = map_.watchdog.tripped) {
    for (std::uint16_t i = 0; i < flag->count; ++i) {
      const auto address = static_cast<std::uint16_t>(flag->address + i);
      switch (flag->function) {
        case 1:
          registers_.define_coil(address);
          break;
        case 2:
          registers_.define_discrete_input(address);
          break;
        case 4:
          registers_.define_input(address);
          break;
        default:
          registers_.define_holding(address, Registers::Access::read_only);
          break;
      }
    }
  }
  if (const auto& clients = map_.watchdog.clients) {
    define_block({clients->function, clients->address, 1, drivers::RegisterKind::uint16},
                 Registers::Access::read_only);
  }
  // The outputs must be defined last. A register that an output shares with a read-back or a flag then
  // remains writable.
  define_block(map_.outputs.registers, Registers::Access::read_write);
  fill_readable_gaps();
  allow_functions();
}

void EmulatedBoard::define_block(const RegisterBlock& block, Registers::Access access) {
  for (std::size_t i = 0; i < block.registers(); ++i) {
    const auto address = static_cast<std::uint16_t>(block.address + i);
    if (reads_input_registers(block)) {
      registers_.define_input(address);
    } else {
      registers_.define_holding(address, access);
    }
  }
}

void EmulatedBoard::define_write(const FixedWrite& write) {
  if (write.function == MODBUS_FC_WRITE_SINGLE_COIL) {
    registers_.define_coil(write.address);
  } else {
    registers_.define_holding(write.address, Registers::Access::read_write);
  }
}

void EmulatedBoard::fill_readable_gaps() {
  std::vector<RegisterBlock> blocks;
  if (map_.has_inputs()) blocks.push_back(map_.inputs.registers);
  if (map_.has_outputs()) blocks.push_back(map_.outputs.registers);
  if (map_.input_status) blocks.push_back(map_.input_status->registers);
  if (map_.read_back) blocks.push_back(map_.read_back->registers);
  std::sort(blocks.begin(), blocks.end(),
            [](const RegisterBlock& a, const RegisterBlock& b) { return a.address < b.address; });
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const int end = blocks[i - 1].address + blocks[i - 1].registers();
    const int gap = blocks[i].address - end;
    if (gap > map_.readable_gap || reads_input_registers(blocks[i]) != reads_input_registers(blocks[i - 1])) {
      continue;
    }
    for (int address = end; address < blocks[i].address; ++address) {
      const auto key = static_cast<std::uint16_t>(address);
      if (reads_input_registers(blocks[i])) {
        if (!registers_.has_input(key)) registers_.define_input(key);
      } else if (!registers_.has_holding(key)) {
        registers_.define_holding(key, Registers::Access::read_only);
      }
    }
  }
}

void EmulatedBoard::allow_functions() {
  constexpr std::array<std::uint8_t, 7> always{MODBUS_FC_READ_COILS,
                                               MODBUS_FC_READ_DISCRETE_INPUTS,
                                               MODBUS_FC_READ_HOLDING_REGISTERS,
                                               MODBUS_FC_READ_INPUT_REGISTERS,
                                               MODBUS_FC_WRITE_SINGLE_COIL,
                                               MODBUS_FC_WRITE_SINGLE_REGISTER,
                                               MODBUS_FC_WRITE_MULTIPLE_REGISTERS};
  for (const std::uint8_t function : always) registers_.allow(function);
  if (map_.has_fc23) registers_.allow(MODBUS_FC_WRITE_AND_READ_REGISTERS);
}

Registers::Answer EmulatedBoard::answer(Nanoseconds now, std::span<const std::uint8_t> pdu) {
  advance(now);
  Registers::Answer answer = registers_.answer(pdu);
  if (feeds(pdu)) {
    fed_at_ = now;
    watchdog_awake_ = true;
  }
  if (!answer.wrote) return answer;

  const bool touched = touches_outputs(pdu);
  if (tripped_) note_clearing(pdu, touched);
  if (touched) {
    commanded_ = true;
    if (!tripped_ && !writes_ignored_) take_outputs();
    // After this call, the registers contain the values that are really at the terminals. Therefore, a client
    // that reads the registers detects a write that was ignored.
    show_outputs();
  }
  return answer;
}

void EmulatedBoard::advance(Nanoseconds now) {
  const auto due = watchdog_due();
  if (!due || now < *due) return;
  tripped_ = true;
  cleared_.assign(map_.watchdog.clear.size(), false);
  go_safe();
  show_tripped();
}

/// Ends the tripped state of the watchdog after all writes that the map lists under `clear` have been
/// received. If the map lists no writes, any write to the outputs ends the tripped state.
void EmulatedBoard::note_clearing(std::span<const std::uint8_t> pdu, bool wrote_outputs) {
  for (std::size_t i = 0; i < cleared_.size(); ++i) {
    if (is_write(pdu, map_.watchdog.clear[i])) cleared_[i] = true;
  }
  const bool all = std::all_of(cleared_.begin(), cleared_.end(), [](bool one) { return one; });
  if (cleared_.empty() ? !wrote_outputs : !all) return;
  tripped_ = false;
  show_tripped();
}

std::optional<Nanoseconds> EmulatedBoard::watchdog_due() const noexcept {
  if (map_.watchdog.kind == BoardWatchdog::Kind::none || !watchdog_awake_ || tripped_) return std::nullopt;
  return fed_at_ + static_cast<Nanoseconds>(map_.watchdog.timeout_s * nanoseconds_per_second);
}

void EmulatedBoard::count_clients(std::size_t clients) {
  const auto& count = map_.watchdog.clients;
  if (!count) return;
  put_raw({count->function, count->address, 1, drivers::RegisterKind::uint16}, 0,
          static_cast<double>(clients));
}

void EmulatedBoard::set_input(std::size_t terminal, double electrical) {
  const drivers::TerminalBlock& inputs = map_.inputs;
  put_raw(inputs.registers, terminal, drivers::quantised_raw(inputs, electrical));
  const auto& status = map_.input_status;
  if (!status || terminal >= status->registers.count) return;
  const double end_a = inputs.scaling.y_at(inputs.raw_min);
  const double end_b = inputs.scaling.y_at(inputs.raw_max);
  std::uint16_t state = status->ok.empty() ? std::uint16_t{0} : status->ok.front();
  if (electrical > std::max(end_a, end_b) && !status->over.empty()) state = status->over.front();
  if (electrical < std::min(end_a, end_b) && !status->under.empty()) state = status->under.front();
  put_raw(status->registers, terminal, state);
}

void EmulatedBoard::set_input_error(std::size_t terminal) {
  const drivers::TerminalBlock& inputs = map_.inputs;
  const double end = std::max(inputs.scaling.y_at(inputs.raw_min), inputs.scaling.y_at(inputs.raw_max));
  set_input(terminal, end + std::abs(end));
  if (!inputs.error_raws.empty()) put_raw(inputs.registers, terminal, inputs.error_raws.front());
}

double EmulatedBoard::raw_in(const RegisterBlock& block, std::size_t index) const {
  std::array<std::uint16_t, 2> words{};
  const std::uint16_t count = drivers::words_of(block.kind);
  for (std::uint16_t i = 0; i < count; ++i) {
    const auto address = static_cast<std::uint16_t>(block.address_of(index) + i);
    words.at(i) = reads_input_registers(block) ? registers_.input(address) : registers_.holding(address);
  }
  return drivers::decode(std::span(words).first(count), block.kind, map_.word_order);
}

void EmulatedBoard::put_raw(const RegisterBlock& block, std::size_t index, double raw) {
  std::array<std::uint16_t, 2> words{};
  const std::uint16_t count = drivers::words_of(block.kind);
  drivers::encode(raw, block.kind, map_.word_order, std::span(words).first(count));
  for (std::uint16_t i = 0; i < count; ++i) {
    const auto address = static_cast<std::uint16_t>(block.address_of(index) + i);
    if (reads_input_registers(block)) {
      registers_.set_input(address, words.at(i));
    } else {
      registers_.set_holding(address, words.at(i));
    }
  }
}

/// Returns true if the request is a heartbeat that feeds the watchdog. If the heartbeat has two alternating
/// values, a repetition of the last value does not feed the watchdog, because the client may hang.
bool EmulatedBoard::is_heartbeat(std::span<const std::uint8_t> pdu) {
  drivers::FixedWrite write = *map_.watchdog.feed_write;
  if (!write.alternate) return is_write(pdu, write);
  const bool first = is_write(pdu, write);
  write.value = *write.alternate;
  if (!first && !is_write(pdu, write)) return false;
  const bool changed = alternated_ != !first;
  alternated_ = !first;
  return changed;
}

bool EmulatedBoard::feeds(std::span<const std::uint8_t> pdu) {
  const BoardWatchdog& watchdog = map_.watchdog;
  switch (watchdog.feed) {
    case BoardWatchdog::Feed::any_request:
      return true;
    case BoardWatchdog::Feed::functions:
      return std::find(watchdog.functions.begin(), watchdog.functions.end(), pdu[0]) !=
             watchdog.functions.end();
    case BoardWatchdog::Feed::feed_write:
      return watchdog.feed_write && is_heartbeat(pdu);
  }
  return false;
}

bool EmulatedBoard::is_write(std::span<const std::uint8_t> pdu, const FixedWrite& write) const {
  if (pdu.size() < 5 || pdu[0] != write.function || word_at(pdu, 1) != write.address) return false;
  constexpr std::uint16_t coil_on = 0xff00;
  switch (pdu[0]) {
    case MODBUS_FC_WRITE_SINGLE_COIL:
      return (word_at(pdu, 3) == coil_on) == (write.value != 0);
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      return word_at(pdu, 3) == write.value;
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return pdu.size() >= 8 && word_at(pdu, 6) == write.value;
    default:
      return false;
  }
}

bool EmulatedBoard::touches_outputs(std::span<const std::uint8_t> pdu) const {
  const RegisterBlock& block = map_.outputs.registers;
  const WrittenRange written = written_by(pdu);
  return written.count > 0 && written.first < std::size_t{block.address} + block.registers() &&
         block.address < written.first + written.count;
}

void EmulatedBoard::take_outputs() {
  const drivers::TerminalBlock& outputs = map_.outputs;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const double raw = raw_in(outputs.registers, i);
    if (std::isnan(raw)) continue;
    outputs_[i] = outputs.scaling.y_at(std::clamp(raw, outputs.raw_min, outputs.raw_max));
  }
}

void EmulatedBoard::show_outputs() {
  const drivers::TerminalBlock& outputs = map_.outputs;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const double raw = outputs.scaling.x_at(outputs_[i]);
    put_raw(outputs.registers, i, raw);
    if (map_.read_back && i < map_.read_back->registers.count) put_raw(map_.read_back->registers, i, raw);
  }
}

void EmulatedBoard::go_safe() {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    outputs_[i] = i < map_.watchdog.safe_electrical.size() ? map_.watchdog.safe_electrical[i] : 0.0;
  }
  show_outputs();
}

void EmulatedBoard::show_tripped() {
  const auto& flag = map_.watchdog.tripped;
  if (!flag) return;
  const std::uint16_t value = tripped_ ? flag->mask : std::uint16_t{0};
  for (std::uint16_t i = 0; i < flag->count; ++i) {
    const auto address = static_cast<std::uint16_t>(flag->address + i);
    switch (flag->function) {
      case 1:
        registers_.set_coil(address, tripped_);
        break;
      case 2:
        registers_.set_discrete_input(address, tripped_);
        break;
      case 4:
        registers_.set_input(address, value);
        break;
      default:
        registers_.set_holding(address, value);
        break;
    }
  }
}

}  // namespace softgrip::simulation
