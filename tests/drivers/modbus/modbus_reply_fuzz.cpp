// Fuzz target: takes arbitrary bytes as the response of a board and processes them until a reading is
// obtained. The first bytes choose the request and the kind of register; the remaining bytes are the
// response.
//
//   Command: scripts/fuzz.sh modbus_reply_fuzz 30

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/board/registers.h"
#include "drivers/modbus/modbus_message.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip::drivers;
using State = ModbusReply::State;

using test::require;

/// Takes bytes from the front of the input. After the last byte, returns 0.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  std::uint16_t word() { return static_cast<std::uint16_t>(byte() << 8 | byte()); }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// Checks that the data of a complete response lie within the received bytes and have the requested size.
void check_complete(const ModbusReply& reply, const ModbusRequest& request,
                    std::span<const std::uint8_t> bytes) {
  require(reply.data.empty() || (reply.data.data() >= bytes.data() &&
                                 reply.data.data() + reply.data.size() <= bytes.data() + bytes.size()));
  const bool writes = request.function == 5 || request.function == 6 || request.function == 16;
  const std::size_t expected = writes                  ? 0
                               : request.function <= 2 ? (request.count + 7U) / 8U
                                                       : 2U * request.count;
  require(reply.data.size() == expected);
}

/// Converts the registers to numbers, scales the numbers, and checks the validity of each reading.
void judge_all(std::span<const std::uint8_t> data, Choices& choices) {
  std::vector<std::uint16_t> words;
  for (std::size_t i = 0; i + 1 < data.size(); i += 2) words.push_back(word_at(data, i));
  BoardMap map;
  map.inputs.registers.kind = static_cast<RegisterKind>(choices.byte() % 5);
  map.word_order = static_cast<WordOrder>(choices.byte() % 4);
  map.inputs.scaling = {0, -10, 65535, 10};
  map.input_status = StatusBlock{.registers = {}, .ok = {0}, .over = {1}, .under = {2}};
  const InputWiring wiring{.input = 0,
                           .unit = ElectricalUnit::volt,
                           .scaling = {0, 0, 10, 50},
                           .valid_min = -1,
                           .valid_max = 11,
                           .error_codes = {{5.5, 0.1}}};
  const std::size_t step = words_of(map.inputs.registers.kind);
  for (std::size_t i = 0; i + step <= words.size(); i += step) {
    const double raw = decode(std::span(words).subspan(i, step), map.inputs.registers.kind, map.word_order);
    const JudgedInput input = judge(map, wiring, raw, words[i]);
    if (input.validity == softgrip::model::Validity::valid) require(std::isfinite(input.physical));
    require(input.validity != softgrip::model::Validity::none_yet);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices({data, size});
  constexpr std::array<std::uint8_t, 9> functions{1, 2, 3, 4, 5, 6, 16, 23, 99};
  ModbusRequest request;
  request.function = functions.at(choices.byte() % functions.size());
  request.address = choices.word();
  request.count = static_cast<std::uint16_t>(choices.byte() % 128);
  const std::array<std::uint16_t, 2> values{choices.word(), 7};
  request.values = std::span(values).first(choices.byte() % 3);
  const std::uint16_t transaction = choices.word();
  const std::uint8_t unit = choices.byte();
  const std::span<const std::uint8_t> bytes = choices.rest();

  // Add the bytes one by one, as they arrive from a slow board, and parse all bytes each time. If additional
  // bytes follow an accepted or refused response, its state must become "defective".
  State last = State::incomplete;
  for (std::size_t have = 0; have <= bytes.size(); ++have) {
    const ModbusReply reply = parse_reply(bytes.first(have), request, transaction, unit);
    if (last != State::incomplete) require(reply.state == State::defective);
    require((reply.defect == ReplyDefect::none) == (reply.state != State::defective));
    require(text_of(reply.defect) != nullptr);
    if (reply.state == State::complete) {
      check_complete(reply, request, bytes.first(have));
      judge_all(reply.data, choices);
    }
    last = reply.state;
  }
  return 0;
}
