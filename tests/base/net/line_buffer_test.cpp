#include "base/net/line_buffer.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <vector>

#include "base/descriptor.h"

namespace softgrip::net::line_buffer_test {
namespace {

std::vector<std::string> lines_of(LineBuffer& buffer) {
  std::vector<std::string> lines;
  while (const auto line = buffer.next()) lines.emplace_back(*line);
  return lines;
}

TEST(LineBuffer, IsEmptyAtFirst) {
  LineBuffer buffer;
  EXPECT_FALSE(buffer.has_line());
  EXPECT_FALSE(buffer.next());
  EXPECT_FALSE(buffer.exceeds(0));
  buffer.append("");
  EXPECT_FALSE(buffer.next());
}

TEST(LineBuffer, JoinsThePartsOfALine) {
  LineBuffer buffer;
  buffer.append("sta");
  EXPECT_FALSE(buffer.has_line());
  EXPECT_FALSE(buffer.next());
  buffer.append("tus");
  EXPECT_FALSE(buffer.next());
  buffer.append("\nqu");
  EXPECT_TRUE(buffer.has_line());
  EXPECT_EQ(lines_of(buffer), std::vector<std::string>{"status"});
  buffer.append("it\n");
  EXPECT_EQ(lines_of(buffer), std::vector<std::string>{"quit"});
}

TEST(LineBuffer, DividesBytesThatContainSeveralLines) {
  LineBuffer buffer;
  buffer.append("a\n\nbc\nd");
  EXPECT_EQ(lines_of(buffer), (std::vector<std::string>{"a", "", "bc"}));
  EXPECT_FALSE(buffer.has_line());
  buffer.append("\n");
  EXPECT_EQ(lines_of(buffer), std::vector<std::string>{"d"});
}

TEST(LineBuffer, KeepsUnreadLinesWhenMoreBytesArrive) {
  LineBuffer buffer;
  buffer.append("a\nb\n");
  EXPECT_EQ(buffer.next(), "a");
  buffer.append("c\nd");
  EXPECT_TRUE(buffer.has_line());
  EXPECT_EQ(lines_of(buffer), (std::vector<std::string>{"b", "c"}));
}

TEST(LineBuffer, EveryDivisionOfTheBytesGivesTheSameLines) {
  const std::string text = "one\r\n\ntwo\nthree\n\n";
  const std::vector<std::string> expected{"one\r", "", "two", "three", ""};
  std::size_t divisions = 0;
  for (std::size_t first = 0; first <= text.size(); ++first) {
    for (std::size_t second = first; second <= text.size(); ++second) {
      LineBuffer buffer;
      std::vector<std::string> lines;
      for (const std::string& part :
           {text.substr(0, first), text.substr(first, second - first), text.substr(second)}) {
        buffer.append(part);
        if (const auto line = buffer.next()) lines.emplace_back(*line);
      }
      for (const std::string& line : lines_of(buffer)) lines.push_back(line);
      ASSERT_EQ(lines, expected) << first << " and " << second;
      ++divisions;
    }
  }
  EXPECT_EQ(divisions, (text.size() + 1) * (text.size() + 2) / 2);
}

TEST(LineBuffer, ExceedsComparesTheLengthOfTheNextLine) {
  LineBuffer buffer;
  buffer.append("1234");
  EXPECT_TRUE(buffer.exceeds(3)) << "an incomplete line";
  EXPECT_FALSE(buffer.exceeds(4));
  buffer.append("\n123456");
  EXPECT_TRUE(buffer.exceeds(3));
  EXPECT_FALSE(buffer.exceeds(4)) << "the line feed and the second line do not count";
  EXPECT_EQ(buffer.next(), "1234");
  EXPECT_TRUE(buffer.exceeds(5));
  EXPECT_FALSE(buffer.exceeds(6)) << "only the second line counts, because the first line has been taken";
}

TEST(LineBuffer, ClearDiscardsAllBytes) {
  LineBuffer buffer;
  buffer.append("a\nb\nc");
  EXPECT_EQ(buffer.next(), "a");
  buffer.clear();
  EXPECT_FALSE(buffer.has_line());
  EXPECT_FALSE(buffer.exceeds(0));
  buffer.append("d\n");
  EXPECT_EQ(lines_of(buffer), std::vector<std::string>{"d"});
}

TEST(LineBuffer, WithoutCrRemovesOneTrailingCarriageReturn) {
  EXPECT_EQ(without_cr("status\r"), "status");
  EXPECT_EQ(without_cr("status"), "status");
  EXPECT_EQ(without_cr("sta\rtus\r\r"), "sta\rtus\r");
  EXPECT_EQ(without_cr("\r"), "");
  EXPECT_EQ(without_cr(""), "");
}

TEST(LineBuffer, ReceivesFromADescriptor) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC), 0);
  const Descriptor reader(ends[0]);
  Descriptor writer(ends[1]);
  LineBuffer buffer;
  EXPECT_EQ(buffer.receive(reader.get()), LineBuffer::Received::nothing);
  ASSERT_EQ(::write(writer.get(), "a\nbcd\n", 6), 6);
  EXPECT_EQ(buffer.receive(reader.get(), 3), LineBuffer::Received::bytes);
  EXPECT_EQ(lines_of(buffer), std::vector<std::string>{"a"});
  writer.reset();
  EXPECT_EQ(buffer.receive(reader.get()), LineBuffer::Received::bytes)
      << "the end is reported only after all bytes have been received";
  EXPECT_EQ(lines_of(buffer), std::vector<std::string>{"bcd"});
  EXPECT_EQ(buffer.receive(reader.get()), LineBuffer::Received::end);
  EXPECT_EQ(buffer.receive(-1), LineBuffer::Received::end) << "reading from an invalid descriptor fails";
}

}  // namespace
}  // namespace softgrip::net::line_buffer_test
