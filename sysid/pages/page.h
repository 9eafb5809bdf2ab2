#pragma once
// The self-contained HTML page that every report is: verdict first, then provenance, then sections.
//
// Readable without JavaScript (there is none), no reference to anything outside, prints well, in the reader's
// colour scheme on a screen. Every text is escaped here; only pictures made in this room enter as markup.
// Figures are numbered in the order in which they come.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// The colour beside a verdict.
enum class Tone { good, doubtful, bad };

/// A table. `numeric` columns are set flush right; missing entries count as text.
struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<bool> numeric;
  std::vector<std::vector<std::string>> rows;
};

/// The table as lines of text, columns aligned; the caption first.
[[nodiscard]] std::string text_of(const Table& table);

/// Terms and their values.
using Terms = std::vector<std::pair<std::string, std::string>>;

/// A report, built from top to bottom.
class Page {
 public:
  /// No page is larger, however long its logs are [bytes]: figures that would make it so give way to a
  /// sentence.
  static constexpr std::size_t most_bytes = 1'500'000;

  /// @param title  of the document. @param verdict  one sentence that a technician understands.
  Page(std::string title, std::string verdict, Tone tone);

  /// Right below the verdict (versions, files, hashes).
  void provenance(Terms entries);
  void section(std::string_view title);
  /// A section that begins on a new sheet of paper: what only those read who check.
  void appendix(std::string_view title);
  void subsection(std::string_view title);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);
  void terms(const Terms& entries);
  void table(const Table& table);
  /// With its number, its caption and itself as a file to keep.
  void figure(Figure figure);
  /// A text in its own lines, in a fixed-width font (a model file).
  void code(std::string_view text);

  /// All figures so far, those too that the page had no room for.
  [[nodiscard]] const std::vector<Figure>& figures() const noexcept { return figures_; }
  /// With a table of contents where there are many sections.
  [[nodiscard]] std::string to_html() const;

 private:
  void heading(std::string_view title, std::string_view more);

  std::string title_;
  std::string verdict_;
  Tone tone_;
  Terms provenance_;
  std::vector<std::string> sections_;
  std::vector<Figure> figures_;
  std::string body_;
};

/// Software name and version, first entry of every provenance.
[[nodiscard]] std::string software_and_version();

/// "figure-2-error-over-time": the stem of a figure's files.
[[nodiscard]] std::string figure_stem(std::size_t number, std::string_view name);

}  // namespace softgrip::sysid
