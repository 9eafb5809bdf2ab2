#include "sysid/pages/page.h"

#include <algorithm>
#include <cctype>

#include "base/numbers.h"
#include "base/version.h"
#include "model/file/model_file.h"
#include "sysid/pages/palette.h"

namespace softgrip::sysid {
namespace {

using result::element, result::escaped, result::html_of;

/// Two numbers of bytes that must remain free below the size limit of a page. After a figure is added,
/// `kept_for_text` bytes must be free. After a copy of a figure that the reader can save is added,
/// `kept_for_figures` bytes must be free.
constexpr std::size_t kept_for_text = 150'000;
constexpr std::size_t kept_for_figures = 450'000;
/// A page has a table of contents if it has at least this number of sections.
constexpr std::size_t many_sections = 3;

constexpr std::string_view style = R"(
:root{--good-paper:#eef8f5;--warn:#b87700;--warn-paper:#fdf6e8;--bad-paper:#fbeeed}
@media screen and (prefers-color-scheme:dark){:root{--good-paper:#12281f;--warn:#e6a532;--warn-paper:#2b2413;--bad-paper:#2f1a18}}
body{font:15px/1.5 system-ui,-apple-system,"Segoe UI",sans-serif;color:var(--text);background:var(--paper);max-width:820px;margin:0 auto;padding:24px 20px 64px}
h1{font-size:19px;font-weight:600;color:var(--muted);margin:0 0 10px}
h2{font-size:20px;margin:40px 0 8px;padding-top:14px;border-top:1px solid var(--grid)}
h3{font-size:16px;margin:24px 0 6px}
p,ul{margin:8px 0;max-width:72ch}
a{color:var(--model)}
.verdict{font-size:19px;line-height:1.4;padding:14px 18px;border-left:6px solid;margin:0 0 18px;max-width:none}
.good{border-color:var(--good);background:var(--good-paper)}.doubtful{border-color:var(--warn);background:var(--warn-paper)}.bad{border-color:var(--bad);background:var(--bad-paper)}
dl{display:grid;grid-template-columns:max-content 1fr;gap:2px 16px;font-size:13px;color:var(--muted);margin:0}
@media screen and (max-width:560px){dl{grid-template-columns:fit-content(45%) minmax(0,1fr)}}
dt{font-weight:600}dd{margin:0;overflow-wrap:anywhere}
nav{font-size:13.5px;margin:14px 0;columns:2}nav a{display:block;text-decoration:none}
table{border-collapse:collapse;font-size:13.5px;margin:12px 0;font-variant-numeric:tabular-nums}
caption{text-align:left;color:var(--muted);padding-bottom:4px}
th{text-align:left;font-weight:600;border-bottom:2px solid var(--faint)}th,td{padding:3px 14px 3px 0;vertical-align:top}
td{border-bottom:1px solid var(--grid)}.n{text-align:right}td.n{white-space:nowrap}
figure{margin:14px 0}figure svg{max-width:100%;height:auto;display:block}
figcaption{font-size:13px;color:var(--muted);margin-top:4px;max-width:90ch}figcaption b{color:var(--text)}
pre{font:12.5px/1.45 ui-monospace,monospace;background:var(--panel);padding:12px;overflow-x:auto}
.scroll{overflow-x:auto}
@page{size:A4;margin:14mm 15mm}
@media print{body{max-width:none;padding:0;font-size:9.5pt;line-height:1.36;print-color-adjust:exact;-webkit-print-color-adjust:exact}h1{margin-bottom:6px}h2{font-size:13pt;margin:14px 0 4px;padding-top:8px;break-after:avoid}h3{font-size:10.5pt;margin:10px 0 2px;break-after:avoid}p,ul,table,figure{margin:5px 0}p,ul,figcaption{max-width:none}.verdict{font-size:12.5pt;padding:8px 12px;margin-bottom:10px}table,dl,figcaption,pre{font-size:8.5pt}th,td{padding:1px 10px 1px 0}figure,tr,.verdict{break-inside:avoid}figure svg{margin:0 auto;max-width:82%}nav,figcaption a{display:none}.appendix{break-before:page}pre{white-space:pre-wrap}}
)";

/// Returns a data URI of an SVG text. Blanks and digits are not escaped, because they are most of the bytes
/// of the text.
std::string uri_of(std::string_view svg) {
  constexpr std::string_view escaped_ones = "%#\"<>&'\n";
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string uri = "data:image/svg+xml,";
  uri.reserve(svg.size() + svg.size() / 8);
  for (const char c : svg) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && escaped_ones.find(c) == std::string_view::npos) {
      uri += c;
    } else {
      uri += {'%', digits[byte >> 4U], digits[byte & 0xfU]};
    }
  }
  return uri;
}

std::string_view class_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "good";
    case Tone::doubtful:
      return "doubtful";
    case Tone::bad:
      return "bad";
  }
  return "";
}

}  // namespace

std::string software_and_version() {
  return "softgrip " + std::string(software_version());
}

Page::Page(std::string title, std::string verdict, Tone tone)
    : title_(std::move(title)), verdict_(std::move(verdict)), tone_(tone) {}

void Page::provenance(Terms entries) {
  provenance_ = std::move(entries);
}

void Page::heading(std::string_view title, std::string_view more) {
  sections_.emplace_back(title);
  body_ += "<h2 id=\"s" + std::to_string(sections_.size()) + '"' + std::string(more) + '>' + escaped(title) +
           "</h2>\n";
}
void Page::section(std::string_view title) {
  heading(title, "");
}
void Page::appendix(std::string_view title) {
  heading(title, " class=\"appendix\"");
}
void Page::subsection(std::string_view title) {
  body_ += element("h3", title);
}
void Page::paragraph(std::string_view text) {
  body_ += element("p", text);
}
void Page::code(std::string_view text) {
  body_ += element("pre", text);
}

void Page::list(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += element("li", item);
  body_ += "</ul>\n";
}

void Page::table(const Table& table) {
  body_ += html_of(table);
}
void Page::terms(const Terms& entries) {
  body_ += html_of(entries);
}

void Page::figure(Figure figure) {
  const std::size_t number = figures_.size() + 1;
  const std::string title = "Figure " + std::to_string(number) + ".";
  const std::string svg = svg_of(figure);
  if (body_.size() + svg.size() + kept_for_text > most_bytes) {
    paragraph(title + " " + figure.caption +
              " This figure is omitted to keep the page small; --figures writes this figure to a file.");
  } else {
    body_ += "<figure id=\"f" + std::to_string(number) + "\">" + svg + "<figcaption><b>" + title + "</b> " +
             escaped(figure.caption);
    const std::string uri = uri_of(svg_file_of(figure));
    if (body_.size() + uri.size() + kept_for_figures < most_bytes)
      body_ += " <a download=\"" + figure_stem(number, figure.name) + ".svg\" href=\"" + uri + "\">SVG</a>";
    body_ += "</figcaption></figure>\n";
  }
  figures_.push_back(std::move(figure));
}

std::string Page::to_html() const {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n" +
      element("title", title_) + "<style>" + scheme_css(":root") + std::string(style) +
      "</style></head>\n<body>\n" + element("h1", title_) + "<p class=\"verdict " +
      std::string(class_of(tone_)) + "\">" + escaped(verdict_) + "</p>\n";
  if (!provenance_.empty()) html += html_of(provenance_);
  if (sections_.size() >= many_sections) {
    html += "<nav>";
    for (std::size_t i = 0; i < sections_.size(); ++i)
      html += "<a href=\"#s" + std::to_string(i + 1) + "\">" + escaped(sections_[i]) + "</a>";
    html += "</nav>\n";
  }
  return html + body_ + "</body></html>\n";
}

std::string figure_stem(std::size_t number, std::string_view name) {
  std::string stem = "figure-" + std::to_string(number);
  bool gap = true;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (plain && gap) stem += '-';
    if (plain) stem += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    gap = !plain;
  }
  return stem;
}

std::vector<std::pair<std::string, std::string>> provenance_of(
    const std::vector<Log>& logs, const std::vector<std::pair<std::string, const model::Model*>>& models) {
  std::vector<std::pair<std::string, std::string>> entries{{"software", software_and_version()}};
  for (const Log& log : logs) {
    const double duration_s = log.time_s.empty() ? 0 : log.time_s.back() - log.time_s.front();
    entries.emplace_back("log " + log.name, log.path + ", " + std::to_string(log.size()) + " samples, " +
                                                significant(duration_s) + " s, sha256 " + log.sha256);
  }
  for (const auto& [role, model] : models) {
    entries.emplace_back(role, model->name + ", hash " + model::model_hash(*model));
  }
  return entries;
}

}  // namespace softgrip::sysid
