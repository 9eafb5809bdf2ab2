#pragma once
// The self-contained HTML page of a report: the verdict first, then the provenance, then the sections.
//
// The page has no JavaScript and no references to other files. It can be printed, and on a screen it uses the
// reader's colour scheme. Every text is escaped here. Only pictures that this folder has produced are
// inserted as markup. Figures are numbered in the order of the page.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// The meaning of a verdict, which determines its colour.
enum class Tone { good, doubtful, bad };

/// A table. `numeric` states for each column if it is right-aligned; columns without an entry are
/// left-aligned text.
struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<bool> numeric;
  std::vector<std::vector<std::string>> rows;
};

/// Returns the table as lines of text with aligned columns; the caption is the first line.
[[nodiscard]] std::string text_of(const Table& table);

/// Terms and their values.
using Terms = std::vector<std::pair<std::string, std::string>>;

/// A report, built from top to bottom.
class Page {
 public:
  /// Largest size of a page [bytes], regardless of the length of the logs. A figure with which the page would
  /// exceed it is replaced by a sentence.
  static constexpr std::size_t most_bytes = 1'500'000;

  /// @param title  title of the document. @param verdict  one sentence for a technician.
  Page(std::string title, std::string verdict, Tone tone);

  /// Adds entries below the verdict: versions, files, hashes.
  void provenance(Terms entries);
  void section(std::string_view title);
  /// Begins a section on a new sheet of paper, for readers who want to verify the result.
  void appendix(std::string_view title);
  void subsection(std::string_view title);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);
  void terms(const Terms& entries);
  void table(const Table& table);
  /// Adds a figure with its number, its caption and a link that saves it as a file.
  void figure(Figure figure);
  /// Adds a text with its line breaks in a fixed-width font, for example a model file.
  void code(std::string_view text);

  /// Returns all figures so far, including those that were replaced by a sentence.
  [[nodiscard]] const std::vector<Figure>& figures() const noexcept { return figures_; }
  /// Returns the page. It has a table of contents if there are at least three sections.
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

/// Returns the name and version of the software, which is the first entry of each provenance.
[[nodiscard]] std::string software_and_version();

/// Returns the stem of the names of a figure's files: "figure-2-error-over-time".
[[nodiscard]] std::string figure_stem(std::size_t number, std::string_view name);

}  // namespace softgrip::sysid
