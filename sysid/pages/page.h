#pragma once
// Builds the self-contained HTML page of a report: the verdict first, then the provenance, then the sections.
//
// The page has no JavaScript and no references to other files. The page can be printed. On a screen, the page
// uses the reader's colour scheme. Every text is escaped. Only pictures that the code in this folder draws
// are inserted as markup. Figures are numbered in the order of the page.
// States the provenance of a result: software, logs and models.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result/table.h"
#include "model/model.h"
#include "sysid/logs/log.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// Rating of a verdict. The rating determines the colour in which the page shows the verdict.
enum class Tone { good, doubtful, bad };

using result::Table, result::Terms, result::text_of;

/// A report page, built from top to bottom.
class Page {
 public:
  /// Largest size of a page [bytes]; it does not depend on the length of the logs. If a figure would make the
  /// page larger than this size, a sentence replaces the figure.
  static constexpr std::size_t most_bytes = 1'500'000;

  /// @param title  title of the document.
  /// @param verdict  one sentence for a technician.
  Page(std::string title, std::string verdict, Tone tone);

  /// Adds entries below the verdict, such as versions, files and hashes.
  void provenance(Terms entries);
  void section(std::string_view title);
  /// Begins a section with details, for readers who want to verify the result. In print, the section begins
  /// on a new sheet.
  void appendix(std::string_view title);
  void subsection(std::string_view title);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);
  void terms(const Terms& entries);
  void table(const Table& table);
  /// Adds a figure with its number and its caption. A link lets the reader save the figure as a file.
  void figure(Figure figure);
  /// Adds a text in a fixed-width font with its line breaks, for example a model file.
  void code(std::string_view text);

  /// Returns all figures that were added, including the figures in whose place the page shows a sentence.
  [[nodiscard]] const std::vector<Figure>& figures() const noexcept { return figures_; }
  /// Returns the page as HTML. The page has a table of contents if it has at least three sections.
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

/// Returns the name and version of the software. This entry is the first one in every provenance.
[[nodiscard]] std::string software_and_version();

/// Returns the common part of the names of a figure's files: "figure-2-error-over-time".
[[nodiscard]] std::string figure_stem(std::size_t number, std::string_view name);

/// Returns the entries for Page::provenance(): the software, each log and each named model with its hash.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> provenance_of(
    const std::vector<Log>& logs, const std::vector<std::pair<std::string, const model::Model*>>& models);

}  // namespace softgrip::sysid
