#include "sysid/health/finger_health.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/files.h"
#include "document/reader.h"
#include "sysid/health/scored_run.h"

namespace softgrip::sysid::health {
namespace {

/// Returns true if the text has the given pattern, in which '0' represents any digit.
bool looks_like(const std::string& text, std::string_view shape) {
  return text.size() == shape.size() &&
         std::equal(text.begin(), text.end(), shape.begin(), [](char have, char want) {
           return want == '0' ? have >= '0' && have <= '9' : have == want;
         });
}

/// Returns true if the text is an existing date, or an existing date with a time of day in UTC.
bool is_date(const std::string& text) {
  const bool timed = looks_like(text, "0000-00-00T00:00:00Z");
  if (!timed && !looks_like(text, "0000-00-00")) return false;
  const auto number = [&](std::size_t at, std::size_t digits) { return std::stoi(text.substr(at, digits)); };
  const std::chrono::year_month_day day{std::chrono::year{number(0, 4)},
                                        std::chrono::month{static_cast<unsigned>(number(5, 2))},
                                        std::chrono::day{static_cast<unsigned>(number(8, 2))}};
  return day.ok() && (!timed || (number(11, 2) < 24 && number(14, 2) < 60 && number(17, 2) < 60));
}

}  // namespace

std::optional<std::vector<Note>> read_notes(const std::string& path, std::string text,
                                            document::Problems& problems) {
  const document::Document document = document::parse(path, std::move(text), problems);
  if (!problems.empty()) return std::nullopt;
  std::vector<Note> notes;
  document::MapReader top(document, document.root, problems, "the notes");
  for (const document::Node* item : top.sequence("notes", true)) {
    document::MapReader reader(document, *item, problems, "a note");
    Note note{reader.text("date"), reader.optional_text("finger").value_or(""),
              reader.text(reader.name_in_use("action", "mended")),
              document.problem(reader.where("finger"), {})};
    if (reader.good("date") && !is_date(note.date))
      reader.report("date", "this is not a date in UTC", "2026-11-03, or 2026-11-03T14:30:00Z");
    notes.push_back(std::move(note));
  }
  top.finish();
  if (!problems.empty()) return std::nullopt;
  std::stable_sort(notes.begin(), notes.end(), [](const Note& a, const Note& b) { return a.date < b.date; });
  return notes;
}

tl::expected<std::vector<Note>, std::string> load_notes(const std::string& path,
                                                        document::Problems& problems) {
  auto text = read_file(path, largest_health_file);
  if (!text) return tl::unexpected(text.error());
  auto notes = read_notes(path, *std::move(text), problems);
  if (!notes) return tl::unexpected(std::string());
  return *std::move(notes);
}

}  // namespace softgrip::sysid::health
