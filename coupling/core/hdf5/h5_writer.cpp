#include "coupling/core/hdf5/h5_writer.hpp"

#include <hdf5.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/h5_handles.hpp"

namespace drumlin {
namespace {

/// Of all that a file holds, at its end.
void append_checksum(const std::filesystem::path& file) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  std::vector<char> piece(1 << 20);
  std::uint32_t sum = 0;
  while (stream.read(piece.data(), static_cast<std::streamsize>(piece.size())), stream.gcount() > 0)
    sum = h5_checksum(std::span(piece).first(static_cast<std::size_t>(stream.gcount())), sum);
  const bool whole = stream.eof();
  stream.clear();
  stream.seekp(0, std::ios::end);
  const std::string end = h5_trailer(sum);
  stream.write(end.data(), static_cast<std::streamsize>(end.size())).flush();
  if (!whole || !stream) throw IoError(file.string() + ": cannot be closed by its checksum");
}

/// To the nearest number of so many binary digits; what is not finite stays.
float rounded_to(float value, int bits) {
  if (!std::isfinite(value)) return value;
  int exponent = 0;
  const float fraction = std::frexp(value, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(fraction, bits + 1)), exponent - bits - 1);
}

constexpr hsize_t all_rows = std::numeric_limits<hsize_t>::max();
constexpr hsize_t packed_piece = 1 << 20;  // bytes of what is unpacked at once, at most

/// In pieces of these lengths.
void pack(hid_t creation, const std::vector<hsize_t>& piece, unsigned int effort) {
  check_h5(H5Pset_chunk(creation, static_cast<int>(piece.size()), piece.data()) >= 0 &&
               H5Pset_shuffle(creation) >= 0 && H5Pset_deflate(creation, effort) >= 0,
           "pack a dataset");
}

/// Rows of a table, from `first` on.
void write_rows(hid_t set, hid_t memory_type, const void* data, hsize_t first, hsize_t rows) {
  const H5Id space(H5Dget_space(set), H5Sclose);
  hsize_t shape[2] = {};
  H5Sget_simple_extent_dims(space.get(), shape, nullptr);
  const hsize_t start[] = {first, 0}, count[] = {rows, shape[1]};
  const H5Id memory(H5Screate_simple(2, count, nullptr), H5Sclose);
  check_h5(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0 &&
               H5Dwrite(set, memory_type, memory.get(), space.get(), H5P_DEFAULT, data) >= 0,
           "write rows of a dataset");
}

/// A string of so many bytes; made once, it stays.
hid_t text_type(std::size_t bytes) {
  static std::map<std::size_t, hid_t> types;
  if (const auto known = types.find(bytes); known != types.end()) return known->second;
  const hid_t type = H5Tcopy(H5T_C_S1);
  check_h5(H5Tset_size(type, bytes) >= 0 && H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0 &&
               H5Tset_cset(type, H5T_CSET_UTF8) >= 0,
           "prepare a text");
  return types[bytes] = type;
}

/// What all datasets have in common, made once: groups on the way to them are made too, and there are no
/// object times, for the same state gives the same bytes.
struct Common {
  hid_t links = H5Pcreate(H5P_LINK_CREATE), creation = H5Pcreate(H5P_DATASET_CREATE),
        scalar = H5Screate(H5S_SCALAR);
  Common() {
    check_h5(H5Pset_create_intermediate_group(links, 1) >= 0 &&
                 H5Pset_obj_track_times(creation, false) >= 0 && scalar >= 0,
             "prepare datasets");
  }
};
const Common& common() {
  static const Common made;  // stays, as the library does
  return made;
}

void describe(hid_t set, H5Words words) {
  if (words.description.empty()) return;
  for (const auto& [key, text] : {std::pair("unit", words.unit), {"description", words.description}}) {
    const hid_t type = text_type(text.size());
    const H5Id attribute(H5Acreate2(set, key, type, common().scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    check_h5(attribute.valid() && H5Awrite(attribute.get(), type, text.data()) >= 0, "describe a dataset");
  }
}

/// What a dataset is made of. Without lengths it is a single number or text.
struct Layout {
  hid_t type;
  std::vector<hsize_t> shape;
  H5Words words = {};
  std::vector<hsize_t> piece = {};  ///< that is packed at once; empty: nothing is
  unsigned int effort = 9;          ///< 1 to 9
};

/// A dataset and the groups on the way to it.
H5Id create_set(hid_t file, const std::string& name, const Layout& layout) {
  const std::vector<hsize_t>& shape = layout.shape;
  const bool single = shape.empty();
  const H5Id space(single ? -1 : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                   H5Sclose);
  const bool packed = !layout.piece.empty();
  const H5Id packing(packed ? H5Pcopy(common().creation) : -1, H5Pclose);
  if (packed) pack(packing.get(), layout.piece, layout.effort);
  const hid_t set = H5Dcreate2(file, name.c_str(), layout.type, single ? common().scalar : space.get(),
                               common().links, packed ? packing.get() : common().creation, H5P_DEFAULT);
  check_h5(set >= 0, "create a dataset");
  describe(set, layout.words);
  return {set, H5Dclose};
}

/// `rows`: of a table, that `data` holds; all of them unless told.
void put(hid_t file, const std::string& name, const void* data, const Layout& layout,
         hsize_t rows = all_rows) {
  const H5Id set = create_set(file, name, layout);
  if (std::find(layout.shape.begin(), layout.shape.end(), hsize_t{0}) != layout.shape.end()) return;
  if (rows != all_rows)
    write_rows(set.get(), layout.type, data, 0, rows);
  else
    check_h5(H5Dwrite(set.get(), layout.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0, "write a dataset");
}

// Files hold low bytes first, as memory does.
static_assert(std::endian::native == std::endian::little);
template <class T>
hid_t type_of() {
  if constexpr (std::is_same_v<T, double>)
    return H5T_IEEE_F64LE;
  else if constexpr (std::is_same_v<T, float>)
    return H5T_IEEE_F32LE;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return H5T_STD_I32LE;
  else
    return H5T_STD_I64LE;
}

}  // namespace

struct H5Content::Handles {
  Handles(hid_t access_list, const char* name)
      : access(access_list, H5Pclose),
        file(std::make_unique<H5Id>(H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose)) {
    check_h5(file->valid(), "create a file");
  }
  H5Id access;
  std::unique_ptr<H5Id> file;
};

H5Content::H5Content(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}
H5Content::~H5Content() = default;

template <class T>
void H5Content::add(const std::string& name, std::span<const T> values, H5Words words) {
  put(handles_->file->get(), name, values.data(), {type_of<T>(), {values.size()}, words});
}
template void H5Content::add(const std::string&, std::span<const double>, H5Words);
template void H5Content::add(const std::string&, std::span<const float>, H5Words);
template void H5Content::add(const std::string&, std::span<const std::int32_t>, H5Words);
template void H5Content::add(const std::string&, std::span<const std::int64_t>, H5Words);

void H5Content::add_array(const std::string& name, std::span<const double> values,
                          const std::vector<std::size_t>& lengths, H5Words words,
                          const std::vector<std::size_t>& piece) {
  put(handles_->file->get(), name, values.data(),
      {type_of<double>(), {lengths.begin(), lengths.end()}, words, {piece.begin(), piece.end()}, 1});
}
void H5Content::add_table(const std::string& name, std::span<const double> values, std::size_t columns,
                          H5Words words) {
  add_array(name, values, {values.size() / columns, columns}, words);
}
void H5Content::add_packed_table(const std::string& name, std::span<const double> values, std::size_t columns,
                                 int bits, H5Words words) {
  std::vector<float> rounded;
  for (const double value : values) rounded.push_back(rounded_to(static_cast<float>(value), bits));
  const hsize_t rows = values.size() / columns, at_once = packed_piece / (columns * sizeof(float));
  std::vector<hsize_t> piece;  // whole rows
  if (rows > 0) piece = {std::clamp<hsize_t>(at_once, 1, rows), columns};
  put(handles_->file->get(), name, rounded.data(), {type_of<float>(), {rows, columns}, words, piece});
}
void H5Content::add_number(const std::string& name, double value, H5Words words) {
  put(handles_->file->get(), name, &value, {type_of<double>(), {}, words});
}
void H5Content::add_number(const std::string& name, std::int64_t value, H5Words words) {
  put(handles_->file->get(), name, &value, {type_of<std::int64_t>(), {}, words});
}
void H5Content::add_scales(const Scales& scales) {
  add_number("scales/length_m", scales.length_m, {"m", "one unit of length, d"});
  add_number("scales/time_s", scales.time_s, {"s", "one unit of time, sqrt(d/g)"});
  add_number("scales/density_kg_m3", scales.density_kg_m3, {"kg/m3", "one unit of density, rho0"});
}
void H5Content::add_text(const std::string& name, const std::string& text) {
  put(handles_->file->get(), name, text.c_str(), {text_type(std::max<std::size_t>(1, text.size())), {}});
}

H5Writer::H5Writer() : H5Content(std::make_unique<Handles>(h5_access_to_memory(), h5_image_name)) {}

std::string H5Writer::image() const {
  check_h5(H5Fflush(handles_->file->get(), H5F_SCOPE_GLOBAL) >= 0, "flush a file image");
  const ssize_t size = H5Fget_file_image(handles_->file->get(), nullptr, 0);
  check_h5(size > 0, "size a file image");
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(size) + h5_trailer_size);  // or the trailer doubles what it holds
  bytes.resize(static_cast<std::size_t>(size));
  check_h5(H5Fget_file_image(handles_->file->get(), bytes.data(), bytes.size()) == size, "copy a file image");
  bytes += h5_trailer(h5_checksum(bytes));
  return bytes;
}
void H5Writer::save(const std::filesystem::path& file, const std::filesystem::path& previous) const {
  replace_file(file, image(), previous);
}

H5FileWriter::H5FileWriter(const std::filesystem::path& file) : H5Content(nullptr), aside_(file) {
  handles_ = std::make_unique<Handles>(h5_access_to_disk(), aside_.path().c_str());
}
H5FileWriter::~H5FileWriter() = default;

void H5FileWriter::begin_table(const std::string& name, std::span<const double> values, std::size_t rows,
                               std::size_t columns, H5Words words) {
  put(handles_->file->get(), name, values.data(), {type_of<double>(), {rows, columns}, words},
      values.size() / columns);
}

void H5FileWriter::add_rows(const std::string& name, std::size_t first_row, std::span<const double> values) {
  const H5Id set(H5Dopen2(handles_->file->get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  check_h5(set.valid(), "open a dataset");
  const H5Id space(H5Dget_space(set.get()), H5Sclose);
  hsize_t shape[2] = {};
  check_h5(H5Sget_simple_extent_dims(space.get(), shape, nullptr) == 2, "open a table");
  write_rows(set.get(), type_of<double>(), values.data(), first_row, values.size() / shape[1]);
}

void H5FileWriter::save() {
  if (!handles_->file->end()) throw IoError(aside_.path().string() + ": HDF5 could not write it");
  append_checksum(aside_.path());
  aside_.commit();
}

}  // namespace drumlin
