#include "simulation/emulator/wire.h"

#include <gtest/gtest.h>

namespace softgrip::simulation::wire_test {
namespace {

const Request request{0x0102, 1, {0x03, 0, 0, 0, 1}};
const Bytes pdu{0x03, 2, 0xab, 0xcd};
const Bytes whole{0x01, 0x02, 0, 0, 0, 5, 1, 0x03, 2, 0xab, 0xcd};

Reply spoiled(FaultKind kind, double seconds = 0, std::uint8_t code = 0) {
  FaultSpec fault;
  fault.kind = kind;
  fault.delay_s = seconds;
  fault.interval_s = seconds;
  fault.code = code;
  return spoiled_reply(Wire::tcp, fault, request, pdu);
}

Bytes only_piece(const Reply& reply) {
  EXPECT_EQ(reply.pieces.size(), 1U);
  EXPECT_FALSE(reply.disconnect);
  return reply.pieces.empty() ? Bytes{} : reply.pieces[0].bytes;
}

TEST(WireFault, AResponseWithoutALineFaultIsUnchanged) {
  EXPECT_EQ(only_piece(good_reply(Wire::tcp, request, pdu)), whole);
  EXPECT_EQ(only_piece(spoiled(FaultKind::sensor_stuck)), whole)
      << "a sensor fault must not change the bytes";
}

TEST(WireFault, ALostRequestOrResponseSendsNoBytes) {
  EXPECT_TRUE(spoiled(FaultKind::lost_request).pieces.empty());
  EXPECT_TRUE(spoiled(FaultKind::no_reply).pieces.empty());
  EXPECT_FALSE(carried_out(FaultKind::lost_request));
  EXPECT_TRUE(carried_out(FaultKind::no_reply));
}

TEST(WireFault, ALateResponseIsDelayed) {
  const Reply reply = spoiled(FaultKind::late_reply, 0.25);
  EXPECT_EQ(only_piece(reply), whole);
  EXPECT_EQ(reply.pieces[0].after, std::chrono::milliseconds(250));
}

TEST(WireFault, ADrippedResponseSendsSingleBytes) {
  const Reply reply = spoiled(FaultKind::dripped_reply, 0.01);
  ASSERT_EQ(reply.pieces.size(), whole.size());
  Bytes together;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(reply.pieces[i].after, std::chrono::milliseconds(10) * static_cast<int>(i));
    together.insert(together.end(), reply.pieces[i].bytes.begin(), reply.pieces[i].bytes.end());
  }
  EXPECT_EQ(together, whole);
}

TEST(WireFault, AWrongHeaderDiffersInExactlyOneField) {
  Bytes expected = whole;
  expected[6] = 2;
  EXPECT_EQ(only_piece(spoiled(FaultKind::wrong_unit)), expected);
  expected = whole;
  expected[1] = 3;
  EXPECT_EQ(only_piece(spoiled(FaultKind::wrong_transaction)), expected);
  expected = whole;
  expected[5] = 6;
  EXPECT_EQ(only_piece(spoiled(FaultKind::wrong_length)), expected);
}

TEST(WireFault, CutRepeatedExceptionAndDisconnectFaultsAreCorrect) {
  EXPECT_EQ(only_piece(spoiled(FaultKind::cut_reply)), (Bytes{0x01, 0x02, 0, 0, 0}));
  const Reply twice = spoiled(FaultKind::repeated_reply);
  ASSERT_EQ(twice.pieces.size(), 2U);
  EXPECT_EQ(twice.pieces[0].bytes, whole);
  EXPECT_EQ(twice.pieces[1].bytes, whole);
  EXPECT_EQ(only_piece(spoiled(FaultKind::exception_reply, 0, 4)),
            (Bytes{0x01, 0x02, 0, 0, 0, 3, 1, 0x83, 4}));
  EXPECT_FALSE(carried_out(FaultKind::exception_reply));
  EXPECT_TRUE(spoiled(FaultKind::disconnect).disconnect);
  EXPECT_TRUE(spoiled(FaultKind::disconnect).pieces.empty());
}

}  // namespace
}  // namespace softgrip::simulation::wire_test
