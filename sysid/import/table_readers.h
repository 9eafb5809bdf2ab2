#pragma once
// Reads the tables of external files, with one function for each format: HDF5 and MATLAB 7.3 (libhdf5),
// MATLAB 4, 5 and 7 (libmatio), LabVIEW measurement files as text (.lvm) and binary (.tdms), text with
// separators, tabs or blanks, and spreadsheet workbooks (.xlsx).
// Reads external files in all supported formats.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads datasets of numbers with one or two dimensions, named by their path ("run1/pressure"), and members
/// of compounds ("table.pressure"). An attribute `units` or `unit` of a dataset states its unit. The
/// attributes scale_factor, add_offset and _FillValue are applied as in netCDF, and a note states the
/// conversion. A dataset is skipped if one of these attributes is not a number. All other objects are
/// skipped, and a note names them. If `matlab` is true, names are written as "run.pressure", and texts, cells
/// and objects are skipped. A file that refers to other files is refused. Otherwise the log could contain
/// data of any file that the user may read. References to other files are external links, external storage
/// and virtual datasets. `path` is the name of the file in messages; libhdf5 opens the path `opened`.
[[nodiscard]] std::optional<ForeignTable> read_hdf5_table(const std::string& path, const std::string& opened,
                                                          bool matlab, document::Problems& problems);

/// Reads variables with real numbers. Fields of structures are named "name.field", elements of arrays of
/// structures "name(2).field", and cells "name{2}". A structure with Name and Data (dSPACE) or with label and
/// values (Simulink) becomes a column with the name that the structure states. Complex numbers are skipped.
/// Objects (timetable, timeseries, table, duration) are skipped too, because only MATLAB can read them. A
/// note names all skipped variables. `path` is the name of the file in messages; libmatio opens the path
/// `opened`. If libmatio reads fewer than `variables` variables, a note states the number of the others. Call
/// mat_variables() first, because libmatio does not detect all damaged files.
[[nodiscard]] std::optional<ForeignTable> read_mat_table(const std::string& path, const std::string& opened,
                                                         std::size_t variables, document::Problems& problems);

[[nodiscard]] bool is_lvm(std::string_view text);

/// Returns the table of an .lvm file; the bounds of table.h apply. The rows of all sections are concatenated.
/// The header states the separator, the decimal mark and, as Y_Unit_Label, the units. If the file has no X
/// column, the times are computed from X0 and Delta_X. The column of comments is left out. It is a problem if
/// the columns of a section differ from the columns of the first section.
[[nodiscard]] std::optional<ForeignTable> read_lvm(const std::string& file, std::string_view bytes,
                                                   const TableOptions& options, document::Problems& problems);

/// Reads channels of numbers, booleans and time stamps, named "group/channel". The property `unit_string` of
/// a channel is its unit. For waveforms, a column "wf_time" is computed from wf_increment, wf_start_offset
/// and wf_start_time. If a segment states a later start, its values begin at this start. A file is refused if
/// a segment states another wf_increment, or a start before the end of the previous values. Channels of text
/// are skipped. Channels whose values require a scale of National Instruments are skipped too. A note names
/// all skipped channels. If the end of a file is missing, the complete rows are read. A note states the
/// number of unread bytes, and the account counts the rows that they contain. Big-endian files, raw DAQmx
/// values and other value types are refused.
[[nodiscard]] std::optional<ForeignTable> read_tdms_table(const std::string& file, std::string_view bytes,
                                                          document::Problems& problems);

/// Reads UTF-8, Latin-1 or UTF-16, with or without a byte order mark (utf8_of() in text_dialect.h). Skips
/// comments, empty lines and the lines above the names. Recognises a row of units. Accepts decimal points or
/// decimal commas, but refuses a file that contains both. If the last line has too few cells, it is left out
/// and counted. It is a problem if another row has a wrong number of cells, unless `options.skip_bad_lines`
/// is true. `file` is the name of the text in messages.
[[nodiscard]] std::optional<ForeignTable> parse_text_table(const std::string& file, std::string_view text,
                                                           const TableOptions& options,
                                                           document::Problems& problems);

/// Hint of the problem that is reported if several sheets of a workbook have rows of numbers. Callers
/// recognise the problem by this hint.
inline constexpr std::string_view select_sheet_hint = "to select one sheet, use --sheet";

/// Reads the sheet that `options.sheet` names. If this option is empty, reads the only sheet with rows of
/// numbers. If several sheets have rows of numbers, a problem lists these sheets. The cells are read like the
/// cells of a text (parse_text_table()), so a workbook gives the same table as CSV with the same cells. The
/// line number of a row is its number in the sheet. Notes name errors, formulas without a stored value,
/// merged cells and other sheets. `file` is the name of the workbook in messages.
[[nodiscard]] std::optional<ForeignTable> read_xlsx_table(const std::string& file, std::string_view bytes,
                                                          const TableOptions& options,
                                                          document::Problems& problems);

/// Returns true if the bytes are a MATLAB file of version 4, or the rest of such a file from a variable on.
/// Such a file has no signature. The header of a variable has five small numbers and a name that ends with a
/// NUL byte.
[[nodiscard]] bool is_matlab_4(std::string_view bytes);

/// Returns the number of variables of a .mat file of version 4 or 5. Adds a problem and returns nullopt if a
/// variable is cut off or damaged, because libmatio returns arbitrary values for such a variable. The sizes
/// of all data elements are compared with the size of the file, and compressed data with their checksum. The
/// file is also refused if its cells, structures and objects together have more than `most_parts` data
/// elements, or more than `most_bytes` bytes after decompression. These bounds are necessary because a
/// compressed file of a few kilobytes can contain millions of empty cells. Arrays of numbers at the top level
/// are not counted. If their values have more than `most_bytes` bytes, the values of the last of these arrays
/// are not checked.
[[nodiscard]] std::optional<std::size_t> mat_variables(const std::string& path, std::string_view file,
                                                       std::size_t most_parts, std::size_t most_bytes,
                                                       document::Problems& problems);

/// Reads text (plain or gzip), XLSX, TDMS, MCAP, MATLAB or HDF5. The first bytes of the file determine its
/// format; the file name has no influence. If `path` is a folder, the function reads run.csv in this folder.
/// The reasons for a refusal are added to `problems`. `unreadable` becomes true if the file could not be
/// opened.
[[nodiscard]] std::optional<ForeignTable> read_foreign_file(const std::string& path,
                                                            const TableOptions& options,
                                                            document::Problems& problems, bool& unreadable);

/// Returns the decompressed gzip data if they have at most `bound` bytes. On failure, returns a sentence that
/// describes the error.
[[nodiscard]] tl::expected<std::string, std::string> gunzipped(std::string_view bytes, std::size_t bound);

}  // namespace softgrip::sysid
