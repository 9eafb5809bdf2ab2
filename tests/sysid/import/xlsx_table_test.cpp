#include "sysid/import/table_readers.h"

#include <gtest/gtest.h>
#include <zip.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/numbers.h"
#include "sysid/import/workbook_package.h"
#include "sysid/import/workbook_sheet.h"

// tests/system/foreign_files.py tests the complete import of workbooks with dates and formulas.
namespace softgrip::sysid::xlsx_table_test {
namespace {

using Parts = std::map<std::string, std::string>;
using Rows = std::vector<std::vector<std::string>>;

std::string archive(const Parts& parts) {
  const ScratchFolder scratch;
  const std::string path = scratch.path() + "/book.xlsx";
  zip_t* const file = zip_open(path.c_str(), ZIP_CREATE, nullptr);
  for (const auto& [name, text] : parts)
    zip_file_add(file, name.c_str(), zip_source_buffer(file, text.data(), text.size(), 0), 0);
  EXPECT_EQ(zip_close(file), 0);
  return read_file(path, std::size_t{64} << 20U).value_or("");
}

/// Returns a workbook. `sheets` maps the name of a sheet to the content of its XML element `worksheet`.
Parts book(const std::map<std::string, std::string>& sheets) {
  Parts parts;
  std::string list;
  std::string relations;
  int number = 0;
  for (const auto& [name, inside] : sheets) {
    const std::string id = std::to_string(++number);
    list += "<sheet name='" + name + "' r:id='r" + id + "'/>";
    relations += "<Relationship Id='r" + id + "' Type='x/worksheet' Target='s" + id + ".xml'/>";
    parts["xl/s" + id + ".xml"] = "<worksheet>" + inside + "</worksheet>";
  }
  parts["_rels/.rels"] =
      "<Relationships><Relationship Id='r1' Type='x/officeDocument' "
      "Target='xl/workbook.xml'/></Relationships>";
  parts["xl/_rels/workbook.xml.rels"] = "<Relationships>" + relations + "</Relationships>";
  parts["xl/workbook.xml"] = "<workbook xmlns:r='r'><sheets>" + list + "</sheets></workbook>";
  return parts;
}

/// Writes numbers as numeric cells and other texts as inline strings. Omits the cell for "".
std::string cells(const Rows& rows, std::size_t first_row = 1, std::size_t first_column = 0) {
  std::string xml = "<sheetData>";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    xml += "<row r='" + std::to_string(first_row + i) + "'>";
    for (std::size_t k = 0; k < rows[i].size(); ++k) {
      const std::string& text = rows[i][k];
      const bool is_number = std::isfinite(to_number(text).value_or(std::nan("")));
      const std::string place = "<c r='" + cell_name(first_row + i, first_column + k) + "'";
      if (is_number) xml += place + "><v>" + text + "</v></c>";
      if (!text.empty() && !is_number) xml += place + " t='inlineStr'><is><t>" + text + "</t></is></c>";
    }
    xml += "</row>";
  }
  return xml + "</sheetData>";
}

const Rows three_rows{{"t_s", "set_kpa", "tip_mm"}, {"0", "1", "2"}, {"0.5", "3", "4"}, {"1", "5", "6"}};

ForeignTable table_of(const Parts& parts, const TableOptions& options = {}) {
  document::Problems problems;
  auto table = read_xlsx_table("b.xlsx", archive(parts), options, problems);
  EXPECT_TRUE(table) << problems.format();
  return table ? *table : ForeignTable{};
}

std::string refusal(const std::string& bytes, const TableOptions& options = {}) {
  document::Problems problems;
  EXPECT_FALSE(read_xlsx_table("b.xlsx", bytes, options, problems));
  return problems.format();
}

std::string refusal(const Parts& parts, const TableOptions& options = {}) {
  return refusal(archive(parts), options);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += note + "\n";
  return text;
}

void expect_same(const ForeignTable& left, const ForeignTable& right) {
  ASSERT_EQ(left.columns.size(), right.columns.size());
  EXPECT_EQ(left.line, right.line);
  EXPECT_EQ(left.account.rows, right.account.rows);
  for (std::size_t i = 0; i < left.columns.size(); ++i) {
    const TableColumn& one = left.columns[i];
    const TableColumn& other = right.columns[i];
    EXPECT_EQ(one.name, other.name);
    EXPECT_EQ(one.bad_count, other.bad_count);
    ASSERT_EQ(one.values.size(), other.values.size());
    for (std::size_t k = 0; k < one.values.size(); ++k)
      EXPECT_TRUE(one.values[k] == other.values[k] ||
                  (std::isnan(one.values[k]) && std::isnan(other.values[k])));
  }
}

TEST(XlsxTable, EqualsACsvFileWithTheSameCells) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
  };
  const std::vector<std::string> others{"", "", "stuck", "-999", "NaN", "1,5 bar", "# spoiled"};
  for (int run = 0; run < 300; ++run) {
    const std::size_t width = 2 + below(5);
    Rows rows(4 + below(40), std::vector<std::string>(width));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < width; ++k) {
        const bool number = k == 0 || below(8) != 0;
        std::string& cell = rows[i][k];
        cell = number ? shortest(static_cast<double>(below(100'000)) / 997) : others[below(others.size())];
        if (i == 0) cell = "column " + std::to_string(k);
      }
    }
    const std::size_t above = below(5);
    std::string csv(above, '\n');
    for (const std::vector<std::string>& row : rows) {
      for (std::size_t k = 0; k < width; ++k)
        csv += (k == 0 ? "" : ",") +
               (row[k].find_first_of(",#") == std::string::npos ? row[k] : '"' + row[k] + '"');
      csv += '\n';
    }
    TableOptions options;
    options.separator = ',';
    document::Problems problems;
    const auto expected = parse_text_table("b.csv", csv, options, problems);
    document::Problems own;
    const auto table =
        read_xlsx_table("b.xlsx", archive(book({{"Run", cells(rows, above + 1, below(3))}})), {}, own);
    ASSERT_EQ(table.has_value(), expected.has_value()) << csv << own.format() << problems.format();
    if (table) expect_same(*table, *expected);
    ASSERT_FALSE(HasFailure()) << csv;
  }
}

TEST(XlsxTable, RequiresASheetNameForSeveralSheets) {
  const Parts parts = book(
      {{"Monday", cells(three_rows)}, {"Notes", cells({{"mass", "2"}})}, {"Tuesday", cells(three_rows)}});
  const std::string said = refusal(parts);
  EXPECT_TRUE(has(said, "2 sheets have rows of numbers: 'Monday', 'Tuesday'")) << said;
  EXPECT_TRUE(has(said, "--sheet")) << said;
  TableOptions options;
  options.sheet = "Tuesday";
  const ForeignTable table = table_of(parts, options);
  EXPECT_EQ(table.sheet, "Tuesday");
  EXPECT_EQ(table.rows(), 3U);
  EXPECT_TRUE(has(joined(table.notes), "sheet 'Monday' is not used\nsheet 'Notes' is not used"));
  options.sheet = "Sunday";
  EXPECT_TRUE(has(refusal(parts, options), "no sheet 'Sunday'"));
  const ForeignTable only =
      table_of(book({{"Monday", cells(three_rows)}, {"Notes", cells({{"mass", "2"}})}}));
  EXPECT_TRUE(has(joined(only.notes),
                  "sheet 'Notes' is skipped, because this sheet does not have two rows of numbers"));
}

TEST(XlsxTable, ReportsMissingCellsAndFormulas) {
  std::string inside = cells(three_rows, 1, 1);
  const auto replace = [&](const std::string& old, const std::string& now) {
    ASSERT_TRUE(has(inside, old)) << old;
    inside.replace(inside.find(old), old.size(), now);
  };
  replace("<c r='D2'><v>2</v>", "<c r='D2' t='e'><v>#N/A</v>");
  replace("<c r='D3'><v>4</v>", "<c r='D3'><f>A1</f>");
  replace("<c r='C4'><v>5</v>", "<c r='C4'><f>A1</f><v>5</v>");
  inside += "<mergeCells><mergeCell ref='B2:C2'/></mergeCells>";
  const ForeignTable table = table_of(book({{"Run", inside}}));
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_TRUE(std::isnan(table.columns[2].values[0]));
  EXPECT_TRUE(std::isnan(table.columns[2].values[1]));
  EXPECT_EQ(table.columns[1].values[2], 5);
  const std::string notes = joined(table.notes);
  for (const char* said :
       {"an error are missing values (1): D2 (#N/A)", "without a stored value are missing values (1): D3",
        "the stored values of formulas are used (1)", "merged cells", "B2:C2", "column 1 is column B"})
    EXPECT_TRUE(has(notes, said)) << said << "\n" << notes;
}

TEST(XlsxTable, WordInANumericColumnIsReportedWithTheCell) {
  Rows rows = three_rows;
  rows[2][2] = "stuck";
  const ForeignTable table = table_of(book({{"Run", cells(rows, 4, 1)}}));
  ASSERT_EQ(table.columns[2].bad.size(), 1U);
  EXPECT_EQ(table.columns[2].bad[0].cell, "D6");
  EXPECT_EQ(table.columns[2].bad[0].at.line, 6);
}

TEST(XlsxTable, RefusesInconsistentCellsAndRows) {
  const auto said = [](const std::string& cell) {
    return refusal(book({{"Run", "<sheetData><row r='7'>" + cell + "</row></sheetData>"}}));
  };
  const std::string shared = said("<c r='B7' t='s'><v>9</v></c>");
  EXPECT_TRUE(has(shared, "b.xlsx, sheet 'Run':7:2: cell B7: shared string '9' is none of the 0")) << shared;
  EXPECT_TRUE(has(said("<c r='B7'><v>nine</v></c>"), "cell B7: 'nine' is not a number"));
  EXPECT_TRUE(has(said("<c r='B7' t='b'><v>2</v></c>"), "cell B7: '2' is not a boolean: 0 or 1 is expected"));
  EXPECT_TRUE(has(said("<c r='B7' t='q'><v>2</v></c>"), "cell B7: its type 'q'"));
  EXPECT_TRUE(has(said("<c r='B8'><v>2</v></c>"), "a cell 'B8' where A7"));
  EXPECT_TRUE(has(said("<c r='B7'><v>2</v></c><c r='B7'><v>3</v></c>"), "a cell 'B7' where C7"));
  EXPECT_TRUE(has(said("<c r='XFE7'><v>2</v></c>"), "a cell 'XFE7'"));
  const std::string rows = refusal(book({{"Run", "<sheetData><row r='3'/><row r='3'/></sheetData>"}}));
  EXPECT_TRUE(has(rows, "a row has the number '3', but a number above 3")) << rows;
  const std::string row =
      refusal(book({{"Run", "<sheetData><row r='B7'><c><v>2</v></c></row></sheetData>"}}));
  EXPECT_TRUE(has(row, "a row has the number 'B7', but a number above 0")) << row;
}

TEST(XlsxTable, RefusesASecondPartOfTextsOrStyles) {
  for (const std::string type : {"sharedStrings", "styles"}) {
    Parts parts = book({{"Run", cells(three_rows)}});
    std::string more;
    for (const std::string id : {"a", "b"}) {
      more += "<Relationship Id='" + id + "' Type='x/" + type + "' Target='" + id + ".xml'/>";
      parts["xl/" + id + ".xml"] = "<part><si><t>x</t></si></part>";
    }
    parts["xl/_rels/workbook.xml.rels"].insert(15, more);
    EXPECT_TRUE(has(refusal(parts), "it has 2 parts '" + type + "' where at most 1 is expected"))
        << refusal(parts);
  }
}

TEST(XlsxTable, RefusesFilesThatAreNoWorkbook) {
  EXPECT_TRUE(has(refusal(Parts{{"content.xml", "x"}}), "OpenDocument"));
  EXPECT_TRUE(has(refusal(Parts{{"a.txt", "x"}}), "an archive, not a workbook"));
  Parts parts = book({{"Run", cells(three_rows)}});
  parts["xl/s1.xml"] = "<worksheet><sheetData>";
  EXPECT_TRUE(has(refusal(parts), "cannot be read"));
  parts.erase("xl/s1.xml");
  EXPECT_TRUE(has(refusal(parts), "its part 'xl/s1.xml' is missing"));
}

/// If bytes of the file are missing or changed, the reader must refuse the file or return the original table.
TEST(XlsxTable, DamagedFileGivesTheOriginalTableOrAnError) {
  const std::string good = archive(book({{"Run", cells(three_rows)}}));
  std::mt19937 random(3);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < 2 * good.size(); ++i) {
    std::string bytes = i < good.size() ? good.substr(0, i) : good;
    if (i >= good.size()) bytes[i - good.size()] = static_cast<char>(random());
    document::Problems problems;
    const auto table = read_xlsx_table("b.xlsx", bytes, {}, problems);
    ASSERT_EQ(table.has_value(), problems.empty()) << i;
    refused += table ? 0U : 1U;
    // A workbook contains checksums. If a workbook has been changed, the reader must refuse it or return the
    // original table.
    if (table) expect_same(*table, table_of(book({{"Run", cells(three_rows)}})));
  }
  EXPECT_GE(refused, good.size());
}

TEST(WorkbookXml, DoesNotExpandEntities) {
  const ForeignTable table = table_of([] {
    Parts parts = book({{"Run", cells({{"t_s", "&big;", "c"}, {"0", "1", "2"}, {"1", "2", "3"}})}});
    parts["xl/s1.xml"] = "<!DOCTYPE w [<!ENTITY big 'xxxx'>]>" + parts["xl/s1.xml"];
    return parts;
  }());
  EXPECT_EQ(table.columns[1].name, "&big;");
}

TEST(WorkbookXml, RefusesATreeThatNeedsTooMuchMemory) {
  std::string text = "<a>";
  for (int i = 0; i < 17'000'000; ++i) text += "<b/>";
  text += "</a>";
  pugi::xml_document document;
  const auto loaded = load_xml(text, document);
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error(), "the sheet has too many cells");
}

/// A text after an element is a separate XML node. The reader must include such texts when it counts the
/// nodes.
TEST(WorkbookXml, CountsTheTextsBetweenElements) {
  std::string text = "<a>";
  for (int i = 0; i < 9'000'000; ++i) text += "<b/>x";
  text += "</a>";
  pugi::xml_document document;
  EXPECT_FALSE(load_xml(text, document));
}

TEST(WorkbookPackage, LimitsTheDecompressedSize) {
  const std::string bytes = archive({{"zeros", std::string(std::size_t{200} << 20U, '0')}});
  EXPECT_LT(bytes.size(), std::size_t{1} << 20U);
  auto package = WorkbookPackage::open(bytes);
  ASSERT_TRUE(package);
  EXPECT_TRUE(package->read("zeros"));
  EXPECT_TRUE(package->read("zeros"));
  const auto third = package->read("zeros");
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error(), "after decompression the workbook has more than 536870912 bytes");
}

TEST(WorkbookSheet, DatesCountFrom1900Or1904) {
  pugi::xml_document document;
  std::string xml =
      "<worksheet><sheetData><row><c s='1'><v>45443.5</v></c><c s='1'><v>0.25</v></c><c s='1'><v>1.25</v></c>"
      "</row></sheetData></worksheet>";
  ASSERT_TRUE(load_xml(xml, document));
  WorkbookTexts texts{{}, {false, true}, false};
  EXPECT_EQ(sheet_text(document, texts)->text,
            "2024-05-31T12:00:00.000000,06:00:00.000000,1904-01-02T06:00:00.000000\n");
  // A title contains a date. The reader must not read the times of day below this title as dates.
  xml =
      "<worksheet><sheetData><row r='1'><c s='1'><v>45443.5</v></c></row>"
      "<row r='2'><c t='str'><v>t</v></c><c t='str'><v>p</v></c></row>"
      "<row r='3'><c s='1'><v>0.5</v></c><c><v>1</v></c></row></sheetData></worksheet>";
  ASSERT_TRUE(load_xml(xml, document));
  EXPECT_EQ(sheet_text(document, texts)->text, "2024-05-31T12:00:00.000000\nt,p\n12:00:00.000000,1\n");
  xml = "<worksheet><sheetData><row><c s='1'><v>45443.5</v></c></row></sheetData></worksheet>";
  ASSERT_TRUE(load_xml(xml, document));
  texts.from_1904 = true;
  EXPECT_TRUE(sheet_text(document, texts)->text.starts_with("2028-06-01T12:00:00"));
}

TEST(WorkbookSheet, LimitsTheSizeOfSharedTexts) {
  std::string xml = "<worksheet><sheetData><row>";
  for (int i = 0; i < 40; ++i) xml += "<c t='s'><v>0</v></c>";
  xml += "</row></sheetData></worksheet>";
  pugi::xml_document document;
  ASSERT_TRUE(load_xml(xml, document));
  WorkbookTexts texts{{std::string(std::size_t{1} << 20U, ' ')}, {}, false};
  EXPECT_TRUE(sheet_text(document, texts));
  texts.strings.front().resize(std::size_t{16} << 20U, ' ');
  const auto text = sheet_text(document, texts);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().message, "cell AG1: the sheet has more than 536870912 bytes of text");
}

TEST(WorkbookSheet, CellsAreNamedLikeInASpreadsheet) {
  EXPECT_EQ(cell_name(7, 0), "A7");
  EXPECT_EQ(cell_name(1, 25), "Z1");
  EXPECT_EQ(cell_name(1, 26), "AA1");
  EXPECT_EQ(cell_name(1, 16383), "XFD1");
}

}  // namespace
}  // namespace softgrip::sysid::xlsx_table_test
