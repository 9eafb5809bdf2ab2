// Tests which texts the parser accepts. If the parser refuses a text, tests the line and the column in the
// error message.

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "tests/document/problems_of.h"

namespace softgrip::document::parse_test {
namespace {

const Node& value_of(const Node& map, std::string_view key) {
  for (const Node::Entry& entry : map.entries) {
    if (entry.key == key) return entry.value;
  }
  static const Node absent;
  ADD_FAILURE() << "no key " << key;
  return absent;
}

std::string repeated(std::string_view text, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < times; ++i) out += text;
  return out;
}

TEST(Parse, KeepsOrderKindsAndLocations) {
  Problems problems;
  const Document document = parse("a.yaml", "b: 1\na: 'two'\nlist: [x, {k: v}]\nnothing:\n", problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  EXPECT_TRUE(document.complete);
  ASSERT_EQ(document.root.entries.size(), 4U);
  EXPECT_EQ(document.root.entries[0].key, "b");
  EXPECT_FALSE(document.root.entries[0].value.quoted);
  EXPECT_EQ(document.root.entries[1].key_at, (Location{2, 1}));
  EXPECT_EQ(document.root.entries[1].value.at, (Location{2, 4}));
  EXPECT_TRUE(document.root.entries[1].value.quoted);
  const Node& list = value_of(document.root, "list");
  ASSERT_EQ(list.items.size(), 2U);
  EXPECT_EQ(list.items[0].scalar, "x");
  EXPECT_EQ(value_of(list.items[1], "k").at, (Location{3, 15}));
  EXPECT_EQ(value_of(document.root, "nothing").kind, Node::Kind::null);
}

TEST(Parse, AcceptsWindowsLineEndsAndCountsColumnsInBytes) {
  Problems problems;
  const Document document = parse("a.yaml", "a: 1\r\n\"ä\": 2\r\n", problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  EXPECT_EQ(document.root.entries[1].value.at, (Location{2, 7}));
  EXPECT_EQ(document.problem({2, 7}, "x").line_text, "\"ä\": 2");
}

TEST(Parse, AnEmptyValueHasALocation) {
  Problems problems;
  const Document document = parse("a.yaml", "a:\n\n# comment below\nb: 1\nc:\n  -\n  - 2\n", problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  EXPECT_EQ(
      value_of(document.root, "a").at.line,
      3);  // the YAML parser gives the empty value the line of the comment (3), not the line of its key (1)
  EXPECT_EQ(value_of(document.root, "c").items[0].at, (Location{6, 3}));
}

TEST(Parse, AFileWithoutContentGivesANullDocument) {
  Problems problems;
  const Document document = parse("a.yaml", "# only a comment\n", problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_TRUE(document.complete);
  EXPECT_EQ(document.root.kind, Node::Kind::null);
}

TEST(Parse, RefusesAnchorsAliasesTagsAndMergeKeys) {
  EXPECT_EQ(problems_of("a: &x 1\nb: *x\n"), (Lines{"1:4: an anchor (`&name`) is not accepted here",
                                                    "2:4: an alias (`*name`) is not accepted here"}));
  EXPECT_EQ(problems_of("a: !!int 1\nb: ! 2\nc: !own {}\n"),
            (Lines{"1:4: a tag (`!name`) is not accepted here", "2:4: a tag (`!name`) is not accepted here",
                   "3:4: a tag (`!name`) is not accepted here"}));
  EXPECT_EQ(problems_of("a: 1\n<<: {b: 2}\n"), (Lines{"2:1: a merge key (`<<`) is not accepted here"}));
  EXPECT_EQ(problems_of("a: *unknown\n"), (Lines{"1:4: an alias (`*name`) is not accepted here"}));
  EXPECT_EQ(problems_of("a: 1\n---\nb: 2\n"), (Lines{"2:1: a second document starts here"}));
  EXPECT_EQ(problems_of("%YAML 1.2\n---\na: 1\n"), (Lines{"1:1: a YAML directive is not accepted here"}));
}

TEST(Parse, QuotedOperatorsAreTexts) {
  EXPECT_EQ(problems_of("a: '*x'\nb: \"&x\"\n'<<': '!t'\n"), Lines{});
}

TEST(Parse, ADuplicateKeyIsRefusedAndTheFirstIsKept) {
  Problems problems;
  const Document document = parse("a.yaml", "a: 1\nb: {k: 1, k: 2, k: 3}\na: 2\n", problems);
  EXPECT_EQ(lines_of(problems),
            (Lines{"2:11: the key `k` already appears at 2:5", "2:17: the key `k` already appears at 2:5",
                   "3:1: the key `a` already appears at 1:1"}));
  EXPECT_EQ(value_of(document.root, "a").scalar, "1");
}

TEST(Parse, KeysArePlainWords) {
  EXPECT_EQ(problems_of("? [a]\n: 1\n{b: 1}: 2\n'': 3\n: 4\n"),
            (Lines{"1:3: a key must be a plain word", "3:1: a key must be a plain word",
                   "4:1: a key must be a plain word", "5:1: a key must be a plain word"}));
}

TEST(Parse, BytesMustBeUtf8AndPrintable) {
  EXPECT_EQ(problems_of("a: \xff\xfe\n"),
            (Lines{"1:4: the byte \\xff is not UTF-8 (and 1 more such bytes)"}));
  EXPECT_EQ(problems_of("a: \xc0\x80\n"),
            (Lines{"1:4: the byte \\xc0 is not UTF-8 (and 1 more such bytes)"}));
  EXPECT_EQ(problems_of("a: \xed\xa0\x80\n").size(), 1U);      // an encoded surrogate, which is invalid in
                                                               // UTF-8
  EXPECT_EQ(problems_of("a: \xf4\x90\x80\x80\n").size(), 1U);  // a code above U+10FFFF, which Unicode does
                                                               // not define
  EXPECT_EQ(problems_of("a: \xc3"), (Lines{"1:4: the byte \\xc3 is not UTF-8"}));
  EXPECT_EQ(problems_of(std::string("a: \0b\n", 6)),
            (Lines{"1:4: the text contains the control character \\x00"}));
  EXPECT_EQ(problems_of("a: \x1b[31m\n"), (Lines{"1:4: the text contains the control character \\x1b"}));
  // The YAML parser treats the character U+0004 as the end of the file and would therefore ignore the text
  // after it.
  EXPECT_EQ(problems_of("a: 1\n\x04: 2\n"), (Lines{"2:1: the text contains the control character \\x04"}));
  EXPECT_EQ(problems_of("\xEF\xBB\xBF"
                        "a: 1\n"),
            (Lines{"1:1: the file starts with a byte order mark"}));
  EXPECT_EQ(problems_of("a: 1\rb: 2\r"),
            (Lines{"1:5: the text contains the control character \\r (and 1 more of them)"}));
  EXPECT_EQ(problems_of("a: müßig \xe2\x82\xac \xf0\x9f\x99\x82\n"), Lines{});
}

TEST(Parse, ATabInTheIndentationIsRefused) {
  EXPECT_EQ(problems_of("a:\n\tb: 1\n  \tc: 2\n"),
            (Lines{"2:1: the indentation contains a tab (and 1 more lines)"}));
  EXPECT_EQ(problems_of("a:\t1\nb: 2\t# comment\n \t\n"), Lines{});
}

TEST(Parse, SyntaxErrorsNameLocationAndCause) {
  EXPECT_EQ(problems_of("a: [1, 2\nb: 3\n"),
            (Lines{"2:2: the list `[...]` that starts at 1:4 is not closed here: expected `,` or `]`"}));
  EXPECT_EQ(problems_of("a: {b: 1\n"),
            (Lines{"2:1: the map `{...}` that starts at 1:4 is not closed here: expected `,` or `}`"}));
  EXPECT_EQ(problems_of("a: b: c\n"), (Lines{"1:5: the value contains a second `: `"}));
  EXPECT_EQ(
      problems_of("a: 1\n  b: 2\n"),
      (Lines{"2:4: this key starts in column 3, but the other keys of the same map start in column 1"}));
  EXPECT_EQ(problems_of("a:1\nb: 2\n"),
            (Lines{"2:2: this is not a key: the line above has no `: ` and continues here"}));
  EXPECT_EQ(problems_of("a: \"\\q\"\n"), (Lines{"1:7: a text in double quotes contains an unknown escape"}));
  EXPECT_EQ(problems_of("a: 1\n- b\n"),
            (Lines{"2:1: this line does not belong to the map that starts at 1:1"}));
  EXPECT_EQ(problems_of("a: @b\n"), (Lines{"1:4: this character cannot start a value"}));
}

TEST(Parse, AnUnclosedQuotationMarkIsReported) {
  // If a file ends with a line break, the YAML parser accepts a quoted text without a closing quote. The
  // check of the project must refuse this text.
  for (const char* const text : {"a: 'open\n", "a: \"open\nb: 2\n\n", "a: \"open \\\"\n", "a: 'it''s\n"}) {
    EXPECT_EQ(problems_of(text), (Lines{"1:4: the quotation mark that opens here is never closed"})) << text;
  }
  EXPECT_EQ(problems_of("a: 'open"), (Lines{"1:9: a quotation mark is opened but never closed"}));
  EXPECT_EQ(problems_of("a: 'it''s'\nb: \"a \\\" b\"\nc: \"\\\\\"\n\"d\": ''\n"), Lines{});
}

TEST(Parse, ValuesBeforeASyntaxErrorAreKept) {
  Problems problems;
  const Document document = parse("a.yaml", "a: 1\nb: [2, {c: 3}, 4\nd: 5\n", problems);
  EXPECT_FALSE(document.complete);
  EXPECT_EQ(value_of(document.root, "a").scalar, "1");
  EXPECT_TRUE(value_of(document.root, "b").refused);
}

TEST(Parse, SizeDepthAndNodeLimitsAreExact) {
  Bounds bounds;
  bounds.bytes = 6;
  EXPECT_EQ(problems_of("a: 12\n", bounds), Lines{});
  EXPECT_EQ(
      problems_of("a: 123\n", bounds),
      (Lines{"1:1: the file is larger than 6 bytes, the largest permitted size of a configuration file"}));
  bounds = {};
  bounds.depth = 3;
  EXPECT_EQ(problems_of("a: [[1]]\n", bounds), Lines{});
  EXPECT_EQ(problems_of("a: [[[1]]]\n", bounds), (Lines{"1:6: the document is nested deeper than 3 levels"}));
  bounds = {};
  bounds.nodes = 5;  // 5 nodes: the map, 2 keys and 2 values
  EXPECT_EQ(problems_of("a: 1\nb: 2\n", bounds), Lines{});
  EXPECT_EQ(problems_of("a: 1\nb: 2\nc: 3\n", bounds), (Lines{"3:1: the document has more than 5 values"}));
}

/// Calls parse() with `text` on a thread with a small stack, and expects that the text is refused.
void parse_on_small_stack(const std::string& text) {
  pthread_attr_t attributes;
  ASSERT_EQ(pthread_attr_init(&attributes), 0);
  // The stack has 512 KiB, because sanitizers enlarge the stack frames and store thread data on the stack.
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, 512 * 1024), 0);
  pthread_t thread{};
  auto run = [](void* argument) -> void* {
    Problems problems;
    static_cast<void>(parse("deep.yaml", *static_cast<const std::string*>(argument), problems));
    return problems.empty() ? nullptr : argument;
  };
  ASSERT_EQ(pthread_create(&thread, &attributes, run, const_cast<std::string*>(&text)), 0);
  void* refused = nullptr;
  ASSERT_EQ(pthread_join(thread, &refused), 0);
  EXPECT_NE(refused, nullptr);
  pthread_attr_destroy(&attributes);
}

TEST(Parse, DeepNestingIsRefusedOnASmallStack) {
  for (const char* const opening : {"[", "{a: ", "- ", "? ", "[{", "- ? ", "{? ", ": "}) {
    SCOPED_TRACE(opening);
    parse_on_small_stack(repeated(opening, 200'000 / std::string(opening).size()));
  }
  std::string stairs;
  for (std::size_t i = 0; i < 500; ++i) stairs += std::string(i, ' ') + "a:\n";
  parse_on_small_stack(stairs);
}

TEST(Parse, AnAliasBombIsRefusedWithinOneSecond) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int j = 0; j < 8; ++j) bomb += ", " + before;
    bomb += "]\n";
  }
  Problems problems;
  const auto start = std::chrono::steady_clock::now();
  static_cast<void>(parse("bomb.yaml", bomb, problems));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
  EXPECT_EQ(problems.size(), 10U + 81U);
}

TEST(Parse, LargeFilesWithinTheLimitsAreReadWithin5Seconds) {
  std::string keys = "{";
  for (int i = 0; i < 9'000; ++i) keys += "key_number_" + std::to_string(i) + ": 1, ";
  const std::string same = "{" + repeated("k: 1, ", 9'000) + "}";
  for (const std::string& text :
       {keys + "}", same, "a: '" + std::string(200'000, 'x') + "'", "[" + repeated("&a ", 80'000),
        repeated("- ", 19'000), repeated("\n", 262'144)}) {
    Problems problems;
    const auto start = std::chrono::steady_clock::now();
    static_cast<void>(parse("large.yaml", text, problems));
    static_cast<void>(problems.format());
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << text.substr(0, 20);
    EXPECT_LE(problems.list().size(), Problems::most);
  }
}

TEST(ParseFile, AnUnreadableFileIsReportedWithTheReason) {
  Problems problems;
  EXPECT_FALSE(parse_file("/nonexistent/rig.yaml", problems).complete);
  EXPECT_FALSE(parse_file("/", problems).complete);
  EXPECT_EQ(lines_of(problems), (Lines{"1:1: the file cannot be read: No such file or directory",
                                       "1:1: the file cannot be read: Is a directory"}));
}

TEST(ParseFile, StopsReadingAtTheSizeLimit) {
  const ScratchFolder scratch;
  const std::string path = scratch.path() + "/large.yaml";
  std::ofstream(path) << "a: 1\n";
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40U);  // a sparse file of 1 TiB, which is larger
                                                                 // than the memory
  Problems problems;
  static_cast<void>(parse_file(path, problems));
  EXPECT_EQ(
      lines_of(problems),
      (Lines{
          "1:1: the file is larger than 262144 bytes, the largest permitted size of a configuration file"}));
}

TEST(ParseFile, RefusesADeviceAndAPipeWithoutWaiting) {
  const ScratchFolder scratch;
  const std::string pipe = scratch.path() + "/rig.yaml";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  Problems problems;
  static_cast<void>(parse_file("/dev/zero", problems));
  static_cast<void>(parse_file(pipe, problems));
  EXPECT_EQ(lines_of(problems), (Lines{"1:1: the file cannot be read: it is a device, not a regular file",
                                       "1:1: the file cannot be read: it is a pipe, not a regular file"}));
}

TEST(ParseFile, ReadsTheContentOfAFile) {
  const ScratchFolder scratch;
  const std::string path = scratch.path() + "/a.yaml";
  std::ofstream(path) << "a: 1\n";
  Problems problems;
  const Document document = parse_file(path, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(document.file, path);
  EXPECT_EQ(document.text, "a: 1\n");
  EXPECT_EQ(document.root.entries.size(), 1U);
}

}  // namespace
}  // namespace softgrip::document::parse_test
