#include "tests/world/master_in_world.h"

#include "base/periodic_schedule.h"
#include "drivers/modbus_server/requests.h"

namespace softgrip::world {
namespace {

/// Longest time for which a master waits for the end of a command. After this time, the master synchronises
/// its counter with the gateway.
constexpr Nanoseconds master_patience = 3 * ns_per_s;
constexpr std::size_t most_wanted = 3;
constexpr auto vent_command = static_cast<std::uint16_t>(plc::CommandCode::vent);

}  // namespace

modbus::Bytes Block::bytes() const {
  modbus::Bytes pdu{16, 0, 0, 0, 7, 14};
  if (only_reads) {
    pdu = {3};
    modbus::append_word(pdu, 0);
    modbus::append_word(pdu, 1);
    return modbus::frame_on(modbus::Wire::tcp, 1, 1, pdu);
  }
  for (const std::uint16_t word : words) modbus::append_word(pdu, word);
  return modbus::frame_on(modbus::Wire::tcp, 1, 1, pdu);
}

void MasterInWorld::want(std::uint16_t code) {
  if (wanted_.size() < most_wanted) wanted_.push_back(code);
}

MasterInWorld::Read MasterInWorld::read(const End& end, const Block& of, Nanoseconds now) {
  Read read;
  if (progress_ == Progress::begins) {
    if (end.outcome == plc::Outcome::executing) return read;
    progress_ = Progress::synchronises;
    counter_ = end.done;
    code_ = 0;
    command_ = -1;
    return read;
  }
  // If the counter, the command code or the command of the response differs from that of the present block,
  // the response belongs to an earlier block.
  if (of.words[0] != counter_ || of.words[1] != code_ || of.command != command_) return read;
  if (end.outcome == plc::Outcome::refused && end.reason == plc::Reason::not_next) {
    read.refused = command_;
    progress_ = Progress::begins;
  } else if (progress_ == Progress::synchronises) {
    progress_ = Progress::ready;
  } else if (progress_ == Progress::waits && end.done == counter_ && end.outcome != plc::Outcome::executing) {
    read.accepted = end.outcome == plc::Outcome::accepted;
    if (end.outcome == plc::Outcome::refused && end.reason != plc::Reason::first_after_start)
      read.refused = command_;
    progress_ = Progress::ready;
  } else if (progress_ == Progress::waits && now - asked_at_ > master_patience) {
    progress_ = Progress::begins;
  }
  return read;
}

bool MasterInWorld::next(int number, Nanoseconds now) {
  if (wanted_.empty()) return false;
  const bool may =
      progress_ == Progress::ready || (progress_ == Progress::waits && wanted_.front() == vent_command);
  if (!may) return false;
  code_ = wanted_.front();
  wanted_.pop_front();
  command_ = number;
  ++counter_;
  asked_at_ = now;
  progress_ = Progress::waits;
  return true;
}

Block MasterInWorld::block(std::uint64_t halts) {
  Block block;
  block.only_reads = progress_ == Progress::begins;
  if (beats && alive && !block.only_reads) ++heartbeat_;
  constexpr std::uint16_t recipe = 1;
  block.words = {counter_, code_, recipe, plc::no_value, plc::no_value, plc::no_value, heartbeat_};
  block.command = command_;
  block.halts = halts;
  return block;
}

}  // namespace softgrip::world
