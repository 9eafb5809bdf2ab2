// Tests the declaration of keys: reading of each type of member, defaults, and the texts for a reference
// page.

#include "document/schema.h"

#include <gtest/gtest.h>

#include "base/enum_table.h"

namespace softgrip::document::schema_test {
namespace {

enum class Mode : std::uint8_t { off, slow, fast };
constexpr auto mode_names =
    enum_names<Mode>({{Mode::off, "off"}, {Mode::slow, "slow"}, {Mode::fast, "fast"}});

struct Base {
  std::string path;
  std::string unit = "mm";
};
struct Settings : Base {
  double margin_mm = 0.5;
  std::uint16_t count = 3;
  bool low = false;
  bool loud = true;
  Mode mode = Mode::slow;
  std::chrono::nanoseconds pause{7};
  std::optional<int> latency_us;
};

Keys<Settings> keys() {
  return {
      required("path", &Settings::path, {}, "a file"),
      required("margin_mm", &Settings::margin_mm, {0.1, 10}, "a margin"),
      required("pause_s", &Settings::pause, {0, 60}, "a pause"),
      {"by_hand", "a list", "none", "read by the caller"},
      optional("count", &Settings::count, {1, 100}, "a count"),
      optional("active", &Settings::low, {"high", "low"}, "a level"),
      optional("loud", &Settings::loud, {}, "a switch"),
      optional("mode", &Settings::mode, mode_names, "a mode"),
      optional("latency_us", &Settings::latency_us, {0, 50}, "a time", "no limit"),
      optional("unit", &Settings::unit, {"mm", "deg"}, "a unit"),
  };
}

Settings read(const std::string& text, Problems& problems) {
  const Document document = parse("file.yaml", text, problems);
  Settings settings;
  MapReader reader(document, document.root, problems, "the map");
  read_keys(reader, keys(), settings);
  return settings;
}

TEST(Schema, StoresAValueOfEachType) {
  Problems problems;
  const Settings settings = read(
      "path: a/b\nmargin_mm: 2.5\npause_s: 1.001\nby_hand: []\ncount: 7\nactive: low\nloud: false\nmode: "
      "fast\n"
      "latency_us: 5\nunit: deg\n",
      problems);
  EXPECT_EQ(problems.format(), "");
  EXPECT_EQ(settings.path, "a/b");
  EXPECT_EQ(settings.margin_mm, 2.5);
  EXPECT_EQ(settings.pause, std::chrono::milliseconds(1001));
  EXPECT_EQ(settings.count, 7);
  EXPECT_TRUE(settings.low);
  EXPECT_FALSE(settings.loud);
  EXPECT_EQ(settings.mode, Mode::fast);
  EXPECT_EQ(settings.latency_us, 5);
  EXPECT_EQ(settings.unit, "deg");
}

TEST(Schema, AnOmittedOptionalKeyKeepsTheDefault) {
  Problems problems;
  const Settings settings = read("path: a\nmargin_mm: 1\npause_s: 1\n", problems);
  EXPECT_EQ(problems.format(), "");
  EXPECT_EQ(settings.count, 3);
  EXPECT_FALSE(settings.low);
  EXPECT_TRUE(settings.loud);
  EXPECT_EQ(settings.mode, Mode::slow);
  EXPECT_FALSE(settings.latency_us.has_value());
  EXPECT_EQ(settings.unit, "mm");
}

TEST(Schema, ReportsMissingUnknownAndWrongKeysAtOnce) {
  Problems problems;
  const Settings settings = read("margin_mm: 11\npause: 1\ncount: 0\nmode: fat\nunit: m\n", problems);
  std::vector<std::string> messages;
  for (const Problem& problem : problems.list()) messages.push_back(problem.message + " / " + problem.hint);
  EXPECT_EQ(messages,
            (std::vector<std::string>{
                "`margin_mm` is 11, allowed is 0.1 to 10 / ", "`count` is 0, allowed is 1 to 100 / ",
                "`mode` must be `off`, `slow` or `fast`, found `fat` / did you mean `fast`?",
                "`unit` must be `mm` or `deg`, found `m` / did you mean `mm`?",
                "unknown key `pause` in the map / the unit is missing: did you mean `pause_s`?",
                "the map lacks the key `path` / "}));
  EXPECT_EQ(settings.margin_mm, 10) << "the nearest permitted value";
}

TEST(Schema, AKeyOfAMemberIsStoredInThisMember) {
  struct Outer {
    Base left, right;
  };
  Problems problems;
  const Document document = parse("file.yaml", "path: a\nunit: deg\n", problems);
  Outer outer;
  {
    MapReader reader(document, document.root, problems, "the map");
    read_keys(reader,
              Keys<Outer>{within(&Outer::right, required("path", &Base::path, {}, "a file")),
                          within(&Outer::left, optional("unit", &Base::unit, {"mm", "deg"}, "a unit"))},
              outer);
  }
  EXPECT_EQ(problems.format(), "");
  EXPECT_EQ(outer.left.path + outer.left.unit + outer.right.path + outer.right.unit, "degamm");
}

TEST(Schema, DescribesTheKeysForAPage) {
  std::vector<std::string> rows;
  const Keys<Base> other{required("file", &Base::path, {}, "a file")};
  for (const KeyFacts& key : facts_of(keys(), other)) {
    rows.push_back(key.name + "|" + key.values + "|" + key.fallback + "|" + key.meaning);
    EXPECT_EQ(key.required(), key.fallback.empty());
  }
  EXPECT_EQ(rows, (std::vector<std::string>{
                      "path|a text||a file", "margin_mm|0.1 to 10||a margin", "pause_s|0 to 60||a pause",
                      "by_hand|a list|none|read by the caller", "count|1 to 100|3|a count",
                      "active|`high` or `low`|`high`|a level", "loud|`true` or `false`|`true`|a switch",
                      "mode|`off`, `slow` or `fast`|`slow`|a mode", "latency_us|0 to 50|no limit|a time",
                      "unit|`mm` or `deg`|`mm`|a unit", "file|a text||a file"}));
}

}  // namespace
}  // namespace softgrip::document::schema_test
