#include "tools/commissioning/examinations.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/clock.h"
#include "drivers/board/registers.h"
#include "drivers/modbus/exchange_plan.h"
#include "drivers/modbus/modbus_board.h"
#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/modbus_message.h"
#include "rig/rig_file.h"

namespace softgrip::tools::doctor {
namespace {

using drivers::BusStatus;
using drivers::ModbusAddress;
using drivers::WordOrder;

// Function codes that read registers, and exception codes after which a different setting of the request may
// work (Modbus Application Protocol V1.1b3, sections 6 and 7).
constexpr std::uint8_t read_holding = 3;
constexpr std::uint8_t read_input = 4;
constexpr unsigned illegal_function = 1;
constexpr unsigned illegal_address = 2;
constexpr unsigned illegal_value = 3;
constexpr unsigned gateway_path = 10;
constexpr unsigned gateway_target = 11;

constexpr double longest_s = 4;
constexpr double shortest_patience_s = 0.2;
constexpr unsigned last_unit_tried = 16;
constexpr unsigned unit_of_many_gateways = 255;

constexpr std::array orders{WordOrder::high_first, WordOrder::low_first, WordOrder::high_first_bytes_swapped,
                            WordOrder::low_first_bytes_swapped};

/// A read request and the response of the module.
struct RegisterRead {
  unsigned unit = 1;
  std::uint8_t function = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;
};
struct Heard {
  BusStatus status = BusStatus::disconnected;
  unsigned exception = 0;
  std::vector<std::uint16_t> words;
  std::string detail;
};

/// A wired input whose registers a read request covers.
struct WiredInput {
  std::string channel;
  drivers::InputWiring wiring;
  std::size_t offset = 0;
};

class BusInquiry {
 public:
  BusInquiry(const rig::RigFile& rig, const drivers::ModbusSettings& settings, std::size_t module,
             Nanoseconds end)
      : rig_(rig),
        module_(settings.modules[module]),
        map_(module_.map),
        address_(settings.links[module_.link]),
        end_(end),
        name_("modbus " + module_.name) {
    const drivers::ExchangePlan plan = drivers::plan_exchange(map_, settings.wiring, module);
    if (plan.reads.empty()) return;
    const drivers::ReadStep& read = plan.reads[plan.sampling_read];
    asked_ = RegisterRead{module_.unit, read.function, read.address, read.count};
    for (std::size_t i = 0; i < settings.wiring.size(); ++i) {
      const auto& slot = plan.channels[i].displacement;
      if (!slot || slot->step != plan.sampling_read) continue;
      inputs_.push_back({settings.wiring[i].name, settings.wiring[i].displacement, slot->offset});
    }
  }

  void examine(Findings& findings) {
    if (asked_.count == 0) return;
    const Heard heard = ask(asked_);
    if (heard.status == BusStatus::ok) return judge_numbers(heard.words, findings);
    if (heard.status == BusStatus::exception) return judge_exception(heard, findings);
    if (heard.status == BusStatus::timed_out || heard.status == BusStatus::bad_reply)
      return judge_silence(heard, findings);
  }

 private:
  /// Sends the request. Opens a session first if no session is open: for the first request, and after a
  /// time-out or a wrong response, which closes the session.
  Heard ask(const RegisterRead& question) {
    const double patience_s = std::max(rig_.loop.exchange_deadline_s, shortest_patience_s);
    Heard heard{BusStatus::timed_out, 0, {}, {}};
    const Nanoseconds now = monotonic_now();
    if (now >= end_) return heard;
    if (link_ == nullptr) link_ = drivers::make_link(address_);
    if (!link_->is_open()) {
      const Nanoseconds connected = std::min(now + rig_.reconnect.connect_deadline.count(), end_);
      heard.status = link_->open(connected);
      if (heard.status == BusStatus::ok) heard.status = link_->settle(connected);
      heard.detail = link_->detail();
      if (heard.status != BusStatus::ok) return heard;
    }
    heard.status =
        link_->ask(static_cast<std::uint8_t>(question.unit),
                   {.function = question.function, .address = question.address, .count = question.count},
                   std::min(monotonic_now() + nanoseconds(patience_s), end_));
    heard.detail = link_->detail();
    heard.exception = link_->exception_code();
    if (heard.status != BusStatus::ok) return heard;
    for (std::size_t i = 0; i < question.count && question.function >= read_holding; ++i)
      heard.words.push_back(drivers::word_at(link_->data(), 2 * i));
    return heard;
  }

  [[nodiscard]] RegisterRead moved(int by) const {
    RegisterRead question = asked_;
    question.address = static_cast<std::uint16_t>(question.address + by);
    return question;
  }
  [[nodiscard]] bool can_move(int by) const {
    const int first = asked_.address + by;
    return first >= 0 && first + asked_.count <= 0x10000;
  }

  void judge_exception(const Heard& heard, Findings& findings) {
    switch (heard.exception) {
      case illegal_function:
        if (try_other_function(heard, findings)) return;
        break;
      case illegal_address:
        if (try_other_function(heard, findings) || try_other_addresses(heard, findings)) return;
        break;
      case illegal_value:
        if (try_fewer_registers(heard, findings)) return;
        break;
      case gateway_path:
      case gateway_target:
        if (try_other_units(heard, findings)) return;
        return findings.fail(name_, heard.detail + ", a response of a gateway",
                             "check `unit` in the rig file, and power and wires behind the gateway");
      default:
        return findings.fail(
            name_, heard.detail,
            "the board responds but reports an internal failure: read the display of the board");
    }
    findings.fail(
        name_, heard.detail,
        "compare the function code, address and count in the board map with the manual of the board");
  }

  /// Sends the request with the other of the two read functions. A board offers its inputs either as holding
  /// registers (function 3) or as input registers (function 4).
  bool try_other_function(const Heard& heard, Findings& findings) {
    const drivers::RegisterBlock& inputs = map_.inputs.registers;
    const int left = inputs.address + static_cast<int>(inputs.registers()) - asked_.address;
    const bool of_inputs = inputs.function == asked_.function && asked_.address >= inputs.address && left > 0;
    if (!of_inputs) return false;
    RegisterRead other = asked_;
    other.function = asked_.function == read_holding ? read_input : read_holding;
    other.count = static_cast<std::uint16_t>(std::min<int>(asked_.count, left));
    const Heard from = ask(other);
    const bool is_sensible = inputs_.empty() || read_as(from.words, map_.word_order).has_value();
    if (from.status != BusStatus::ok || (heard.exception == illegal_address && !is_sensible)) return false;
    findings.fail(name_, fmt::format("{}; function {} is accepted", heard.detail, other.function),
                  fmt::format("write `function: {}` for `inputs`{} in the board map", other.function,
                              map_.has_fc23 ? " and `fc23: false`" : ""));
    return true;
  }

  bool try_other_addresses(const Heard& heard, Findings& findings) {
    for (const int by : {-1, 1}) {
      if (!can_move(by) || ask(moved(by)).status != BusStatus::ok) continue;
      findings.fail(name_,
                    fmt::format("{}; the board accepts the request if it begins one register {}, at {}, so "
                                "the addresses in the board map are wrong by one",
                                heard.detail, by < 0 ? "lower" : "higher", asked_.address + by),
                    base_advice(by));
      return true;
    }
    return false;
  }

  [[nodiscard]] std::string base_advice(int by) const {
    const int base = map_.address_base - by;
    return base == 0 || base == 1
               ? fmt::format(
                     "write `address_base: {}` in the board map, or correct the addresses in the board map",
                     base)
               : std::string("correct the addresses in the board map by one");
  }

  bool try_fewer_registers(const Heard& heard, Findings& findings) {
    RegisterRead fewer = asked_;
    while (fewer.count > 1) {
      fewer.count = static_cast<std::uint16_t>(fewer.count / 2);
      if (ask(fewer).status != BusStatus::ok) continue;
      findings.fail(
          name_,
          fmt::format("{}; the board accepts a request of {} registers, but no request of {} registers",
                      heard.detail, fewer.count, asked_.count),
          fmt::format("write `max_registers: {}` in the board map", fewer.count));
      return true;
    }
    return false;
  }

  bool try_other_units(const Heard& heard, Findings& findings) {
    for (unsigned unit = 1; unit <= last_unit_tried + 1; ++unit) {
      RegisterRead other = asked_;
      other.unit = unit > last_unit_tried ? unit_of_many_gateways : unit;
      if (other.unit == asked_.unit) continue;
      const Heard from = ask(other);
      const bool of_gateway = from.exception == gateway_path || from.exception == gateway_target;
      const bool answers =
          from.status == BusStatus::ok || (from.status == BusStatus::exception && !of_gateway);
      if (!answers) continue;
      findings.fail(
          name_,
          fmt::format("{}; unit id {} responds, unit id {} does not", heard.detail, other.unit, asked_.unit),
          fmt::format("write `unit: {}` in the rig file if this unit id belongs to the board", other.unit));
      return true;
    }
    return false;
  }

  /// Searches for the cause of a time-out or a malformed response: tries another framing, then another unit
  /// id.
  void judge_silence(const Heard& heard, Findings& findings) {
    if (const auto* tcp = std::get_if<drivers::TcpAddress>(&address_)) {
      drivers::TcpAddress other = *tcp;
      other.rtu_framing = !tcp->rtu_framing;
      if (try_address(other)) {
        return findings.fail(
            name_, heard.detail + "; the board responds to requests with the other framing",
            fmt::format("write `framing: {}` in the rig file", other.rtu_framing ? "rtu" : "tcp"));
      }
      other = *tcp;
      other.numbered = false;
      if (tcp->numbered && !tcp->rtu_framing && try_address(other)) {
        return findings.fail(
            name_, heard.detail + "; the responses of the board are correct except for the transaction id",
            "the gateway does not return the transaction id. To accept the risk, write "
            "`accept_no_transaction_id` in the rig file");
      }
    }
    if (try_other_units(heard, findings)) return;
    findings.fail(name_, heard.detail,
                  heard.status == BusStatus::bad_reply
                      ? "compare `unit` in the rig file with the unit id of the board; check for another "
                        "Modbus client on the line"
                      : "no unit id responds: check the power and the wires of the board, and check that the "
                        "port is a Modbus port");
  }

  bool try_address(const drivers::TcpAddress& other) {
    const ModbusAddress own = address_;
    address_ = other;
    link_.reset();
    const BusStatus status = ask(asked_).status;
    address_ = own;
    link_.reset();
    return status == BusStatus::ok || status == BusStatus::exception;
  }

  /// Returns the readings of the wired inputs as text; nullopt if a reading is not valid.
  [[nodiscard]] std::optional<std::string> read_as(const std::vector<std::uint16_t>& words,
                                                   WordOrder order) const {
    const drivers::RegisterKind kind = map_.inputs.registers.kind;
    std::string text;
    for (const WiredInput& input : inputs_) {
      if (input.offset + drivers::words_of(kind) > words.size()) return std::nullopt;
      const double raw =
          drivers::decode(std::span(words).subspan(input.offset, drivers::words_of(kind)), kind, order);
      const drivers::JudgedInput judged = drivers::judge(map_, input.wiring, raw, std::nullopt);
      if (judged.validity != model::Validity::valid) return std::nullopt;
      text += fmt::format("{}{} {:.2f} mm", text.empty() ? "" : ", ", input.channel, judged.physical);
    }
    return text;
  }

  void judge_numbers(const std::vector<std::uint16_t>& words, Findings& findings) {
    if (inputs_.empty() || read_as(words, map_.word_order)) return;
    struct Fit {
      WordOrder order;
      int by;
      std::string shown;
    };
    std::vector<Fit> fits;
    for (const int by : {0, -1, 1}) {
      if (!can_move(by)) continue;
      const std::vector<std::uint16_t> there = by == 0 ? words : ask(moved(by)).words;
      for (const WordOrder order : orders) {
        const bool one_word = drivers::words_of(map_.inputs.registers.kind) == 1;
        if (one_word && (order == WordOrder::low_first || order == WordOrder::low_first_bytes_swapped))
          continue;
        if (auto shown = read_as(there, order)) fits.push_back({order, by, std::move(*shown)});
      }
    }
    // If several interpretations of the registers give valid readings, the cause is uncertain and is not
    // reported.
    if (fits.size() != 1) return;
    const Fit& fit = fits.front();
    const std::string name(drivers::name_of(fit.order));
    if (fit.by != 0) {
      return findings.fail(
          name_,
          fmt::format("the inputs at the addresses of the board map are implausible. One register {}, the "
                      "board has the plausible inputs {}, so the addresses are probably wrong by one",
                      fit.by < 0 ? "lower" : "higher", fit.shown),
          base_advice(fit.by));
    }
    findings.fail(name_,
                  fmt::format("the inputs are implausible with the word order `{}`; with `{}`, the inputs "
                              "are {}, so the word order is probably wrong",
                              drivers::name_of(map_.word_order), name, fit.shown),
                  fmt::format("write `word_order: {}` in the board map", name));
  }

  const rig::RigFile& rig_;
  const drivers::ModbusModuleSettings& module_;
  const drivers::BoardMap& map_;
  ModbusAddress address_;
  Nanoseconds end_;
  std::string name_;
  RegisterRead asked_{};
  std::vector<WiredInput> inputs_;
  std::unique_ptr<drivers::ModbusLink> link_;
};

}  // namespace

bool wants_bus_examination(const Findings& findings) {
  return std::any_of(findings.list().begin(), findings.list().end(), [](const Finding& finding) {
    return finding.verdict == Verdict::fail &&
           (finding.name == "board" || finding.name.starts_with("sensor "));
  });
}

void examine_bus(const rig::RigFile& rig, Findings& findings) {
  const auto* const settings = std::get_if<drivers::ModbusSettings>(&rig.board);
  if (settings == nullptr) return;
  const Nanoseconds end = monotonic_now() + nanoseconds(longest_s);
  for (std::size_t module = 0; module < settings->modules.size(); ++module)
    BusInquiry(rig, *settings, module, end).examine(findings);
}

}  // namespace softgrip::tools::doctor
