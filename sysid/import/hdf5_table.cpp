#include "sysid/import/table_readers.h"

#include <hdf5.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include "base/numbers.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {
namespace {

constexpr int deepest_group = 8;
constexpr std::size_t longest_unit = 64;
constexpr int most_objects = 100'000;
constexpr std::size_t most_type_bytes = std::size_t{1} << 20U;
constexpr std::size_t most_chunk_bytes = std::size_t{256} << 20U;

/// Owns an identifier of libhdf5 and closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle(Handle&&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

std::string text_of(hid_t attribute, hid_t type) {
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    const Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(memory.get(), H5T_VARIABLE);
    H5Tset_cset(memory.get(), H5Tget_cset(type));
    if (H5Aread(attribute, memory.get(), &text) < 0 || text == nullptr) return {};
    const std::unique_ptr<char, herr_t (*)(void*)> owned(text, H5free_memory);
    return std::string(text).substr(0, longest_unit);
  }
  const std::size_t size = H5Tget_size(type);
  if (size == 0 || size > longest_unit) return {};
  std::string text(size, '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return {};
  return text.substr(0, text.find('\0'));
}

/// Returns the text of an attribute of an object. Returns "" if the object has no text attribute with this
/// name.
std::string attribute_text(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const bool one_text =
      attribute && H5Tget_class(type.get()) == H5T_STRING && H5Sget_simple_extent_npoints(space.get()) == 1;
  return one_text ? text_of(attribute.get(), type.get()) : std::string();
}

std::string unit_of(hid_t dataset) {
  for (const char* name : {"units", "unit", "Units", "Unit"}) {
    if (std::string unit = attribute_text(dataset, name); !unit.empty()) return unit;
  }
  return {};
}

/// Returns true for the MATLAB classes of numbers. Returns false for other classes, such as texts, although
/// MATLAB stores them as numbers too.
bool is_matlab_number(const std::string& kind) {
  return kind.empty() || kind == "double" || kind == "single" || kind == "logical" ||
         kind.find("int") != std::string::npos;
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

/// Reads an attribute of an object as a number. If the object has no attribute with this name, `value` keeps
/// its value. Returns false if the attribute is not exactly one number.
bool read_number(hid_t object, const char* name, double& value) {
  if (H5Aexists(object, name) <= 0) return true;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  return attribute && is_number(type.get()) && H5Sget_simple_extent_npoints(space.get()) == 1 &&
         H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) >= 0;
}

/// Attributes of a dataset with packed values, from "NetCDF Users Guide", appendix A, Attribute Conventions.
struct Packing {
  double scale = 1;
  double offset = 0;
  double fill = missing_value;  ///< stored value that means a missing value; NaN: no such value
};

/// Rounds a number to the floating-point type of a dataset. Other types keep the number.
double rounded_to(hid_t type, double value) {
  std::array<std::byte, 64> buffer{};
  if (H5Tget_class(type) != H5T_FLOAT || H5Tget_size(type) > buffer.size()) return value;
  double rounded = value;
  std::memcpy(buffer.data(), &value, sizeof value);
  if (H5Tconvert(H5T_NATIVE_DOUBLE, type, 1, buffer.data(), nullptr, H5P_DEFAULT) < 0 ||
      H5Tconvert(type, H5T_NATIVE_DOUBLE, 1, buffer.data(), nullptr, H5P_DEFAULT) < 0)
    return value;
  std::memcpy(&rounded, buffer.data(), sizeof rounded);
  return rounded;
}

/// Reads the attributes of packed values. Returns an error sentence if an attribute is not a number;
/// otherwise returns an empty text.
/// @param type  type of the stored values.
std::string read_packing(hid_t dataset, hid_t type, Packing& packing) {
  const auto refused = [](const char* name) {
    return "its attribute " + std::string(name) + " is not a number";
  };
  if (!read_number(dataset, "scale_factor", packing.scale) || !std::isfinite(packing.scale))
    return refused("scale_factor");
  if (!read_number(dataset, "add_offset", packing.offset) || !std::isfinite(packing.offset))
    return refused("add_offset");
  if (!read_number(dataset, "_FillValue", packing.fill)) return refused("_FillValue");
  // The attribute can have more digits than the stored values.
  packing.fill = rounded_to(type, packing.fill);
  return {};
}

/// Replaces the stored values of a dataset by the values that they mean. Returns a text that states the
/// changes; empty if no value is changed.
std::string unpack(const Packing& packing, std::vector<double>& values) {
  constexpr int digits = 9;
  const bool is_scaled = packing.scale != 1 || packing.offset != 0;
  std::size_t missing = 0;
  for (double& value : values) {
    const bool is_missing = value == packing.fill;
    missing += is_missing ? 1 : 0;
    value = is_missing ? missing_value : value * packing.scale + packing.offset;
  }
  std::string changes;
  if (is_scaled)
    changes = "the stored values are multiplied by " + significant(packing.scale, digits) +
              " (scale_factor), and " + significant(packing.offset, digits) + " is added (add_offset)";
  if (missing > 0)
    changes += (is_scaled ? "; " : "") + std::to_string(missing) +
               (missing == 1 ? " stored value of " : " stored values of ") +
               significant(packing.fill, digits) +
               (missing == 1 ? " counts as missing (_FillValue)" : " count as missing (_FillValue)");
  return changes;
}

/// Converts values from the row-major order of HDF5 to column-major order.
std::vector<double> by_columns(const std::vector<double>& values, std::size_t rows, std::size_t columns) {
  std::vector<double> turned(values.size());
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < columns; ++k) turned[k * rows + i] = values[i * columns + k];
  }
  return turned;
}

void collect_members(hid_t dataset, hid_t type, const std::string& name, std::size_t rows,
                     ArrayCollector& arrays) {
  const int members = H5Tget_nmembers(type);
  for (int i = 0; i < members; ++i) {
    const std::unique_ptr<char, herr_t (*)(void*)> member(H5Tget_member_name(type, static_cast<unsigned>(i)),
                                                          H5free_memory);
    const Handle kind(H5Tget_member_type(type, static_cast<unsigned>(i)), H5Tclose);
    if (!member) continue;
    if (!is_number(kind.get())) {
      arrays.skip(name + "." + member.get(),
                  H5Tget_class(kind.get()) == H5T_ARRAY ? "an array in each row" : "no numbers");
      continue;
    }
    if (!arrays.has_room(rows, 1)) {
      arrays.skip(name + "." + member.get(), too_large);
      continue;
    }
    const Handle one(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
    H5Tinsert(one.get(), member.get(), 0, H5T_NATIVE_DOUBLE);
    std::vector<double> values(rows);
    if (H5Dread(dataset, one.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      arrays.skip(name + "." + member.get(), "this dataset cannot be read");
    } else {
      arrays.add(name + "." + member.get(), {}, rows, 1, values);
    }
  }
}

/// Returns the number of bytes that libhdf5 has to decompress to read one value of a dataset. Returns 0 for a
/// dataset without chunks.
std::size_t chunk_bytes(hid_t dataset, hid_t type) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  std::array<hsize_t, 2> chunk{1, 1};
  if (H5Pget_layout(creation.get()) != H5D_CHUNKED || H5Pget_chunk(creation.get(), 2, chunk.data()) < 0)
    return 0;
  // libhdf5 stores both dimensions of a chunk in 32 bits, so their product does not overflow 64 bits. The
  // size in bytes is computed only for a product up to most_chunk_bytes, so the size does not overflow
  // either.
  const hsize_t values = chunk[0] * chunk[1];
  return values > most_chunk_bytes ? values : values * H5Tget_size(type);
}

void collect_dataset(hid_t dataset, const std::string& name, ArrayCollector& arrays) {
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  std::array<hsize_t, 2> size{1, 1};
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 1 || rank > 2) return arrays.skip(name, std::to_string(rank) + " dimensions");
  H5Sget_simple_extent_dims(space.get(), size.data(), nullptr);
  // MATLAB stores the size of an empty array as the values of a dataset.
  double is_empty = 0;
  (void)read_number(dataset, "MATLAB_empty", is_empty);
  if (size[0] == 0 || size[1] == 0 || is_empty != 0) return arrays.skip(name, "empty");
  if (!arrays.has_room(size[0], size[1])) return arrays.skip(name, too_large);
  if (H5Tget_size(type.get()) > most_type_bytes)
    return arrays.skip(name, "a single value has more than 1 MiB");
  if (chunk_bytes(dataset, type.get()) > most_chunk_bytes)
    return arrays.skip(name, "the chunks of the dataset have more than 256 MiB");
  if (H5Tget_class(type.get()) == H5T_COMPOUND && rank == 1)
    return collect_members(dataset, type.get(), name, size[0], arrays);
  const std::string matlab_class = attribute_text(dataset, "MATLAB_class");
  if (!is_number(type.get()) || !is_matlab_number(matlab_class))
    return arrays.skip(name,
                       matlab_class.empty() ? "no numbers" : "MATLAB's " + matlab_class + ", no numbers");
  Packing packing;
  if (const std::string wrong = read_packing(dataset, type.get(), packing); !wrong.empty())
    return arrays.skip(name, wrong);
  std::vector<double> values(size[0] * size[1]);
  if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    return arrays.skip(name, "this dataset cannot be read");
  if (const std::string changes = unpack(packing, values); !changes.empty())
    arrays.note("'" + document::shown(name) + "': " + changes);
  if (matlab_class.empty()) {
    arrays.add(name, unit_of(dataset), size[0], size[1], by_columns(values, size[0], size[1]));
  } else {
    // MATLAB stores the dimensions of an array in reverse order.
    arrays.add(name, {}, size[1], size[0], values);
  }
}

/// Returns an error sentence if another file contains the values of the dataset; otherwise returns an empty
/// text.
std::string foreign_storage(hid_t dataset) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pget_external_count(creation.get()) > 0)
    return "the values of the dataset are in another file (external storage)";
  if (H5Pget_layout(creation.get()) == H5D_VIRTUAL)
    return "the values of the dataset are in other datasets (virtual dataset)";
  return {};
}

/// State of the loop over all groups and datasets of a file.
struct Walk {
  ArrayCollector& arrays;
  char separator = '/';
  hid_t access = H5P_DEFAULT;  ///< HDF5 property list with which libhdf5 follows links
  std::string refused{};       ///< reason why the file is refused; empty: the file is not refused
  std::string hint = "copy the values into one HDF5 file, without references to other files";
  int objects = 0;
};

struct Visit {
  Walk& walk;
  std::string prefix;
  int depth = 0;
};

herr_t visit(hid_t group, const char* name, const H5L_info_t* info, void* data);

/// Visits all objects of a group. A damaged group is refused, because its remaining objects are unknown.
void visit_all(hid_t group, const std::string& path, Visit inside) {
  if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &inside) >= 0) return;
  inside.walk.refused = "the group '" + document::shown(path) + "' cannot be read";
  inside.walk.hint = "the file is damaged. Write it again, or copy the readable values into another file";
}

herr_t visit(hid_t group, const char* name, const H5L_info_t* info, void* data) {
  auto& where = *static_cast<Visit*>(data);
  Walk& walk = where.walk;
  if (name[0] == '#') return 0;  // objects whose names begin with # are internal objects of MATLAB
  const std::string path = where.prefix + name;
  // The number of objects is limited, because groups that link to each other in a cycle would otherwise be
  // read without end.
  if (++walk.objects > most_objects) {
    walk.refused = "the file has more than " + std::to_string(most_objects) + " objects";
  } else if (info->type != H5L_TYPE_HARD && info->type != H5L_TYPE_SOFT) {
    walk.refused = "'" + document::shown(path) + "' is a link to another file (external link)";
  }
  if (!walk.refused.empty()) return 1;
  const Handle object(H5Oopen(group, name, walk.access), H5Oclose);
  if (!object) {
    walk.arrays.skip(path, "this object cannot be opened");
    return 0;
  }
  const H5I_type_t kind = H5Iget_type(object.get());
  if (kind == H5I_DATASET) {
    if (const std::string foreign = foreign_storage(object.get()); !foreign.empty())
      walk.refused = "'" + document::shown(path) + "': " + foreign;
    else
      collect_dataset(object.get(), path, walk.arrays);
  }
  if (kind == H5I_GROUP && where.depth >= deepest_group) {
    walk.arrays.skip(path, "only " + std::to_string(deepest_group) + " levels of groups are read");
  } else if (kind == H5I_GROUP) {
    visit_all(object.get(), path, {walk, path + walk.separator, where.depth + 1});
  }
  return walk.refused.empty() ? 0 : 1;
}

/// Refuses an external link, so that libhdf5 does not open another file. Links to objects of the same file
/// are followed.
herr_t refuse_external_link(const char* /*parent_file*/, const char* /*parent_group*/, const char* /*file*/,
                            const char* /*object*/, unsigned* /*flags*/, hid_t /*access*/, void* /*data*/) {
  return -1;
}

}  // namespace

std::optional<ForeignTable> read_hdf5_table(const std::string& path, const std::string& opened, bool matlab,
                                            document::Problems& problems) {
  // Prevents libhdf5 from printing errors, because this function reports them as problems.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle file(H5Fopen(opened.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) {
    problems.add(
        {path, {1, 1}, {}, "this HDF5 file cannot be read: it is broken, cut off, or open for writing", {}});
    return std::nullopt;
  }
  ArrayCollector arrays(path);
  const Handle access(H5Pcreate(H5P_LINK_ACCESS), H5Pclose);
  H5Pset_elink_cb(access.get(), refuse_external_link, nullptr);
  Walk walk{arrays, matlab ? '.' : '/', access.get()};
  visit_all(file.get(), "/", {walk, {}, 0});
  if (!walk.refused.empty()) {
    problems.add({path, {1, 1}, {}, "not read: " + walk.refused, walk.hint});
    return std::nullopt;
  }
  return arrays.table(matlab ? "MATLAB 7.3" : "HDF5", problems);
}

}  // namespace softgrip::sysid
