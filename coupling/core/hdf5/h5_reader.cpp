#include "coupling/core/hdf5/h5_reader.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <cstring>
#include <limits>
#include <type_traits>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/hdf5/h5_handles.hpp"
#include "coupling/core/hdf5/h5_storage.hpp"

namespace drumlin {
namespace {

constexpr const char* elsewhere = "a soft or external link (allowed: data at this position)";

/// Hands HDF5 an image that the reader keeps: HDF5 would copy it twice. Nothing is ever written to it.
H5FD_file_image_callbacks_t callbacks_for(std::string& bytes) {
  H5FD_file_image_callbacks_t calls{};
  calls.image_malloc = [](size_t, H5FD_file_image_op_t, void* image) -> void* {
    return static_cast<std::string*>(image)->data();
  };
  calls.image_memcpy = [](void* to, const void*, size_t, H5FD_file_image_op_t, void*) { return to; };
  calls.image_free = [](void*, H5FD_file_image_op_t, void*) -> herr_t { return 0; };
  calls.udata_copy = [](void* image) { return image; };
  calls.udata_free = [](void*) -> herr_t { return 0; };
  calls.udata = &bytes;
  return calls;
}

}  // namespace

struct H5Reader::Handles {
  std::string bytes;  // outlives the file
  bool has_trailer = false;
  std::unique_ptr<H5Id> file;
};

H5Reader::H5Reader(const std::filesystem::path& file, bool checked)
    : handles_(std::make_unique<Handles>()), file_(file) {
  std::string& bytes = handles_->bytes = input_bytes(file, largest_binary_file());
  if (bytes.empty()) throw InputError(file.string() + ": is empty");
  const bool has_trailer = handles_->has_trailer =
      bytes.size() > h5_trailer_size && std::memcmp(bytes.data() + bytes.size() - h5_trailer_size,
                                                    h5_trailer_word.data(), h5_trailer_word.size()) == 0;
  if (checked && !has_trailer)
    throw InputError(file.string() + ": not a Drumlin file, or cut short (no checksum at its end)");
  if (has_trailer) {
    const std::size_t size = bytes.size() - h5_trailer_size;
    std::uint32_t stored = 0;
    for (int byte = 0; byte < 4; ++byte)
      stored |= std::uint32_t{static_cast<unsigned char>(bytes[size + 8 + byte])} << (8 * byte);
    if (stored != h5_checksum({bytes.data(), size}))
      throw InputError(file.string() + ": damaged (checksum does not match)");
    bytes.resize(size);
  }
  const H5Id access{h5_access_to_memory(), H5Pclose};
  H5FD_file_image_callbacks_t calls = callbacks_for(bytes);
  check_h5(H5Pset_file_image_callbacks(access.get(), &calls) >= 0 &&
               H5Pset_file_image(access.get(), bytes.data(), bytes.size()) >= 0,
           "take a file image");
  handles_->file = std::make_unique<H5Id>(H5Fopen(h5_image_name, H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!handles_->file->valid()) throw InputError(file.string() + ": not an HDF5 file");
}
H5Reader::~H5Reader() = default;

void H5Reader::refuse(const std::string& name, const std::string& what, const std::string& allowed) const {
  throw InputError({InputProblem{file_.string(), 0, 0, name, what, allowed}});
}

bool H5Reader::ends_in_checksum() const { return handles_->has_trailer; }

bool H5Reader::has(const std::string& name) const {
  // H5Lexists wants every group on the way to exist.
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    if (H5Lexists(handles_->file->get(), part.c_str(), H5P_DEFAULT) <= 0) return false;
    // Links lead anywhere: to other files, to other data, round in circles.
    if (is_soft_or_external_link(handles_->file->get(), part.c_str())) refuse(part, elsewhere);
    if (end == std::string::npos) return true;
  }
}

std::vector<std::size_t> H5Reader::shape(const std::string& name) const {
  if (!has(name)) refuse(name, "missing dataset");
  const H5Id set(H5Dopen2(handles_->file->get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) refuse(name, "not a dataset");
  const H5Id space(H5Dget_space(set.get()), H5Sclose);
  const int dimensions = H5Sget_simple_extent_ndims(space.get());
  if (dimensions < 0) refuse(name, "of an impossible shape");
  std::vector<hsize_t> lengths(static_cast<std::size_t>(dimensions));
  H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr);
  return {lengths.begin(), lengths.end()};
}

namespace {

bool is_fixed_text(hid_t type) { return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0; }

/// Of a fixed string, or the bytes that older files have in its place, T is char.
template <class T>
std::vector<T> read_set(const H5Reader& reader, hid_t file, const std::string& name, hid_t type,
                        H5T_class_t wanted) {
  if (!reader.has(name)) reader.refuse(name, "missing dataset");
  const H5Id set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) reader.refuse(name, "not a dataset");
  const H5Id stored(H5Dget_type(set.get()), H5Tclose);
  const H5T_class_t found = H5Tget_class(stored.get());
  const bool words = std::is_same_v<T, char> && is_fixed_text(stored.get());
  if (found != wanted && !(wanted == H5T_FLOAT && found == H5T_INTEGER) && !words)
    reader.refuse(name, "of an unexpected type");
  const H5Id space(H5Dget_space(set.get()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (const char* fault = storage_fault(set.get(), stored.get(), count)) reader.refuse(name, fault);
  std::vector<T> values(static_cast<std::size_t>(count) * (words ? H5Tget_size(stored.get()) : 1));
  if (count > 0 &&
      H5Dread(set.get(), words ? stored.get() : type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    reader.refuse(name, "unreadable");
  return values;
}

void refuse_outside(const H5Reader& reader, const std::string& name, std::int64_t value, std::int64_t low,
                    std::int64_t high) {
  if (value >= low && value <= high) return;
  const bool endless = high == std::numeric_limits<std::int64_t>::max();
  reader.refuse(name, "is " + std::to_string(value),
                std::to_string(low) + (endless ? " or more" : " to " + std::to_string(high)));
}

void refuse_outside(const H5Reader& reader, const std::string& name, double value, H5Range range) {
  constexpr double most = largest_value;
  const double least = range == H5Range::finite ? -most : 1 / most;
  const bool may_be_0 = range != H5Range::above_0;
  if ((value >= least && value <= most) || (may_be_0 && value == 0)) return;
  reader.refuse(name, fmt::format("is {}", value),
                fmt::format("finite, {}{:g} to {:g}", range == H5Range::from_0 ? "0 or " : "", least, most));
}

}  // namespace

std::vector<double> H5Reader::doubles(const std::string& name) const {
  return read_set<double>(*this, handles_->file->get(), name, H5T_NATIVE_DOUBLE, H5T_FLOAT);
}
std::vector<float> H5Reader::floats(const std::string& name) const {
  return read_set<float>(*this, handles_->file->get(), name, H5T_NATIVE_FLOAT, H5T_FLOAT);
}
std::vector<std::int32_t> H5Reader::ints(const std::string& name) const {
  return read_set<std::int32_t>(*this, handles_->file->get(), name, H5T_NATIVE_INT32, H5T_INTEGER);
}
std::vector<std::int64_t> H5Reader::longs(const std::string& name) const {
  return read_set<std::int64_t>(*this, handles_->file->get(), name, H5T_NATIVE_INT64, H5T_INTEGER);
}
double H5Reader::number(const std::string& name) const {
  const auto values = doubles(name);
  if (values.size() != 1) refuse(name, "not a single number");
  return values[0];
}
std::vector<double> H5Reader::doubles(const std::string& name, H5Range range) const {
  std::vector<double> values = doubles(name);
  for (const double value : values) refuse_outside(*this, name, value, range);
  return values;
}
double H5Reader::number(const std::string& name, H5Range range) const {
  const double value = number(name);
  refuse_outside(*this, name, value, range);
  return value;
}
std::int64_t H5Reader::integer(const std::string& name) const {
  const auto values = longs(name);
  if (values.size() != 1) refuse(name, "not a single number");
  return values[0];
}
std::int64_t H5Reader::integer(const std::string& name, std::int64_t low, std::int64_t high) const {
  const std::int64_t value = integer(name);
  refuse_outside(*this, name, value, low, high);
  return value;
}
std::vector<std::int32_t> H5Reader::ints(const std::string& name, std::int32_t low, std::int32_t high) const {
  std::vector<std::int32_t> values = ints(name);
  for (const std::int32_t value : values) refuse_outside(*this, name, value, low, high);
  return values;
}
Scales H5Reader::scales() const {
  const auto scale = [this](const char* name) { return number(name, H5Range::above_0); };
  return {scale("scales/length_m"), scale("scales/time_s"), scale("scales/density_kg_m3")};
}
std::string H5Reader::text(const std::string& name) const {
  const auto bytes = read_set<char>(*this, handles_->file->get(), name, H5T_NATIVE_UINT8, H5T_INTEGER);
  const std::string text(bytes.begin(), bytes.end());
  return text.substr(0, text.find_last_not_of('\0') + 1);
}

void H5Reader::require_format(const std::string& format, const std::string& otherwise) const {
  if (!has("format")) refuse("format", "missing");
  if (const std::string found = text("format"); found != format)
    refuse("format", "'" + found + "', this version reads " + format + otherwise);
}

namespace {

struct Link {
  std::string name;
  bool leads_elsewhere;
};

/// Why a group or dataset is not read; null: nothing speaks against it.
const char* fault_of_object(hid_t file, const std::string& name) {
  const H5Id set(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose);
  const H5I_type_t object = set.valid() ? H5Iget_type(set.get()) : H5I_BADID;
  if (object == H5I_GROUP) return nullptr;
  if (object != H5I_DATASET) return "not a dataset";
  const H5Id type(H5Dget_type(set.get()), H5Tclose), space(H5Dget_space(set.get()), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT && !is_fixed_text(type.get())) return "of an unexpected type";
  return storage_fault(set.get(), type.get(), H5Sget_simple_extent_npoints(space.get()));
}

}  // namespace

void H5Reader::require_readable() const {
  std::vector<Link> links;
  const auto note = [](hid_t, const char* name, const H5L_info_t* link, void* to) -> herr_t {
    static_cast<std::vector<Link>*>(to)->push_back({name, link->type != H5L_TYPE_HARD});
    return 0;
  };
  const hid_t file = handles_->file->get();
  if (H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, note, &links) < 0) refuse("/", "unreadable");
  for (const Link& link : links) {
    if (link.leads_elsewhere) refuse(link.name, elsewhere);
    if (const char* fault = fault_of_object(file, link.name)) refuse(link.name, fault);
  }
}

void require_readable(const std::filesystem::path& file) {
  const H5Reader in(file, false);
  in.require_readable();
  if (in.has("format") && !in.ends_in_checksum())
    throw InputError(file.string() + ": not a Drumlin file, or cut short (no checksum at its end)");
}

}  // namespace drumlin
