#include "coupling/files/h5_image.hpp"

#include <hdf5.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "coupling/common/errors.hpp"
#include "coupling/common/input_file.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/files/h5_storage.hpp"

namespace drumlin {
namespace {

constexpr std::string_view trailer_magic = "DRUMLCRC";
constexpr std::size_t trailer_size = 8 + 4;
// HDF5 wants a name for an image in memory and looks whether a file of that name exists: this one cannot.
constexpr const char* image_name = "/dev/null/image";

std::uint32_t checksum(std::span<const char> bytes) {
  const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), first, bytes.size()));
}

/// An HDF5 identifier that closes itself.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// Before its time; whether HDF5 had nothing to say.
  bool end() { return close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(bool good, const char* what) {
  if (!good) throw IoError(std::string("HDF5 could not ") + what);
}

/// Begins to use HDF5, which crashes if it is used after it could not start. It prints nothing, for we report
/// its failures ourselves, and tidies nothing up when the program ends: after a failure that crashes too.
void start_library() {
  static const bool started = [] {
    (void)H5dont_atexit();  // refused where another part of the program has started it
    check(H5open() >= 0, "start");
    return H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  }();
  (void)started;
}

/// How a file image is opened: in memory.
hid_t access_to_memory() {
  start_library();
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  check(access >= 0 && H5Pset_fapl_core(access, 1 << 20, false) >= 0, "prepare a file image");
  return access;
}

/// How a file on the disk is opened: nobody else knows its name, so that it needs no lock.
hid_t access_to_disk() {
  start_library();
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  check(access >= 0 && H5Pset_fapl_sec2(access) >= 0 && H5Pset_file_locking(access, false, true) >= 0,
        "prepare a file");
  return access;
}

std::string trailer(std::uint32_t sum) {
  std::string bytes(trailer_magic);
  for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(sum >> (8 * byte));
  return bytes;
}

/// Of all that a file holds, at its end.
void append_checksum(const std::filesystem::path& file) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  std::vector<char> piece(1 << 20);
  uLong sum = crc32_z(0, nullptr, 0);
  while (stream.read(piece.data(), static_cast<std::streamsize>(piece.size())), stream.gcount() > 0)
    sum = crc32_z(sum, reinterpret_cast<const unsigned char*>(piece.data()),
                  static_cast<std::size_t>(stream.gcount()));
  const bool whole = stream.eof();
  stream.clear();
  stream.seekp(0, std::ios::end);
  const std::string end = trailer(static_cast<std::uint32_t>(sum));
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

/// Whole rows to a piece.
void pack(hid_t creation, std::initializer_list<hsize_t> shape) {
  const hsize_t rows = *std::data(shape), row_bytes = *(std::data(shape) + 1) * sizeof(float);
  const hsize_t piece[] = {std::clamp<hsize_t>(packed_piece / row_bytes, 1, rows), *(std::data(shape) + 1)};
  check(H5Pset_chunk(creation, 2, piece) >= 0 && H5Pset_shuffle(creation) >= 0 &&
            H5Pset_deflate(creation, 9) >= 0,
        "pack a dataset");
}

/// Rows of a table, from `first` on.
void write_rows(hid_t set, hid_t memory_type, const void* data, hsize_t first, hsize_t rows) {
  const Id space(H5Dget_space(set), H5Sclose);
  hsize_t shape[2] = {};
  H5Sget_simple_extent_dims(space.get(), shape, nullptr);
  const hsize_t start[] = {first, 0}, count[] = {rows, shape[1]};
  const Id memory(H5Screate_simple(2, count, nullptr), H5Sclose);
  check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0 &&
            H5Dwrite(set, memory_type, memory.get(), space.get(), H5P_DEFAULT, data) >= 0,
        "write rows of a dataset");
}

/// A dataset of a type and shape, and the groups on the way to it.
Id create_set(hid_t file, const std::string& name, hid_t file_type, std::initializer_list<hsize_t> shape,
              bool packed) {
  const Id links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  check(H5Pset_create_intermediate_group(links.get(), 1) >= 0, "create a group");
  const Id space(H5Screate_simple(static_cast<int>(shape.size()), std::data(shape), nullptr), H5Sclose);
  // No object times: the same state gives the same bytes.
  const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(H5Pset_obj_track_times(creation.get(), false) >= 0, "leave out times");
  if (packed) pack(creation.get(), shape);
  const hid_t set =
      H5Dcreate2(file, name.c_str(), file_type, space.get(), links.get(), creation.get(), H5P_DEFAULT);
  check(set >= 0, "create a dataset");
  return {set, H5Dclose};
}

/// `rows`: of a table, that `data` holds; all of them unless told.
void put(hid_t file, const std::string& name, hid_t memory_type, hid_t file_type, const void* data,
         std::initializer_list<hsize_t> shape, bool packed = false, hsize_t rows = all_rows) {
  const Id set = create_set(file, name, file_type, shape, packed);
  if (std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end()) return;
  if (rows != all_rows)
    write_rows(set.get(), memory_type, data, 0, rows);
  else
    check(H5Dwrite(set.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0, "write a dataset");
}

}  // namespace

struct H5Content::Handles {
  Handles(hid_t access_list, const char* name)
      : access(access_list, H5Pclose),
        file(std::make_unique<Id>(H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose)) {
    check(file->valid(), "create a file");
  }
  Id access;
  std::unique_ptr<Id> file;
};

H5Content::H5Content(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}
H5Content::~H5Content() = default;

void H5Content::add(const std::string& name, std::span<const double> values) {
  put(handles_->file->get(), name, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, values.data(), {values.size()});
}
void H5Content::add(const std::string& name, std::span<const float> values) {
  put(handles_->file->get(), name, H5T_NATIVE_FLOAT, H5T_IEEE_F32LE, values.data(), {values.size()});
}
void H5Content::add(const std::string& name, std::span<const std::int32_t> values) {
  put(handles_->file->get(), name, H5T_NATIVE_INT32, H5T_STD_I32LE, values.data(), {values.size()});
}
void H5Content::add(const std::string& name, std::span<const std::int64_t> values) {
  put(handles_->file->get(), name, H5T_NATIVE_INT64, H5T_STD_I64LE, values.data(), {values.size()});
}
void H5Content::add_table(const std::string& name, std::span<const double> values, std::size_t columns) {
  put(handles_->file->get(), name, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, values.data(),
      {values.size() / columns, columns});
}
void H5Content::add_packed_table(const std::string& name, std::span<const double> values, std::size_t columns,
                                 int bits) {
  std::vector<float> rounded;
  for (const double value : values) rounded.push_back(rounded_to(static_cast<float>(value), bits));
  put(handles_->file->get(), name, H5T_NATIVE_FLOAT, H5T_IEEE_F32LE, rounded.data(),
      {values.size() / columns, columns}, !values.empty());
}
void H5Content::add_number(const std::string& name, double value) {
  add(name, std::span<const double>(&value, 1));
}
void H5Content::add_number(const std::string& name, std::int64_t value) {
  add(name, std::span<const std::int64_t>(&value, 1));
}
void H5Content::add_text(const std::string& name, const std::string& text) {
  put(handles_->file->get(), name, H5T_NATIVE_UINT8, H5T_STD_U8LE, text.data(), {text.size()});
}

H5Writer::H5Writer() : H5Content(std::make_unique<Handles>(access_to_memory(), image_name)) {}

std::string H5Writer::image() const {
  check(H5Fflush(handles_->file->get(), H5F_SCOPE_GLOBAL) >= 0, "flush a file image");
  const ssize_t size = H5Fget_file_image(handles_->file->get(), nullptr, 0);
  check(size > 0, "size a file image");
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(size) + trailer_size);  // or the trailer doubles what it holds
  bytes.resize(static_cast<std::size_t>(size));
  check(H5Fget_file_image(handles_->file->get(), bytes.data(), bytes.size()) == size, "copy a file image");
  bytes += trailer(checksum(bytes));
  return bytes;
}
void H5Writer::save(const std::filesystem::path& file) const { replace_file(file, image()); }
void H5Writer::save_keeping(const std::filesystem::path& file, const std::filesystem::path& previous) const {
  replace_file_keeping(file, previous, image());
}

H5FileWriter::H5FileWriter(const std::filesystem::path& file) : H5Content(nullptr), aside_(file) {
  handles_ = std::make_unique<Handles>(access_to_disk(), aside_.path().c_str());
}
H5FileWriter::~H5FileWriter() = default;

void H5FileWriter::begin_table(const std::string& name, std::span<const double> values, std::size_t rows,
                               std::size_t columns) {
  put(handles_->file->get(), name, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, values.data(), {rows, columns}, false,
      values.size() / columns);
}

void H5FileWriter::add_rows(const std::string& name, std::size_t first_row, std::span<const double> values) {
  const Id set(H5Dopen2(handles_->file->get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  check(set.valid(), "open a dataset");
  const Id space(H5Dget_space(set.get()), H5Sclose);
  hsize_t shape[2] = {};
  check(H5Sget_simple_extent_dims(space.get(), shape, nullptr) == 2, "open a table");
  write_rows(set.get(), H5T_NATIVE_DOUBLE, values.data(), first_row, values.size() / shape[1]);
}

namespace {

template <class T>
hid_t file_type_of() {
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

template <class T>
void H5FileWriter::begin_array(const std::string& name, std::size_t count) {
  static_assert(std::endian::native == std::endian::little);
  const Id set = create_set(handles_->file->get(), name, file_type_of<T>(), {count}, false);
  places_.push_back(0);
  if (count == 0) return;
  // HDF5 finds room for an array when its first number is written.
  const Id space(H5Dget_space(set.get()), H5Sclose);
  const hsize_t start[] = {0}, one[] = {1};
  const Id memory(H5Screate_simple(1, one, nullptr), H5Sclose);
  const T zero{};
  check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, one, nullptr) >= 0 &&
            H5Dwrite(set.get(), file_type_of<T>(), memory.get(), space.get(), H5P_DEFAULT, &zero) >= 0,
        "begin an array");
  const haddr_t place = H5Dget_offset(set.get());
  check(place != HADDR_UNDEF, "find room for an array");
  places_.back() = place;
}
template void H5FileWriter::begin_array<double>(const std::string&, std::size_t);
template void H5FileWriter::begin_array<float>(const std::string&, std::size_t);
template void H5FileWriter::begin_array<std::int32_t>(const std::string&, std::size_t);
template void H5FileWriter::begin_array<std::int64_t>(const std::string&, std::size_t);

std::vector<std::uint64_t> H5FileWriter::end_content() {
  if (!handles_->file->end()) throw IoError(aside_.path().string() + ": HDF5 could not write it");
  ended_ = true;
  return std::exchange(places_, {});
}

void H5FileWriter::close() {
  if (!ended_) (void)end_content();
  append_checksum(aside_.path());
}
void H5FileWriter::save() {
  close();
  aside_.take_the_place();
}
void H5FileWriter::save_keeping(const std::filesystem::path& previous) {
  close();
  aside_.take_the_place_keeping(previous);
}

namespace {

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
  std::unique_ptr<Id> file;
};

H5Reader::H5Reader(const std::filesystem::path& file, bool checked)
    : handles_(std::make_unique<Handles>()), file_(file) {
  std::string& bytes = handles_->bytes = input_bytes(file, largest_binary_file);
  if (bytes.empty()) throw InputError(file.string() + ": is empty");
  const bool has_trailer =
      bytes.size() > trailer_size && std::memcmp(bytes.data() + bytes.size() - trailer_size,
                                                 trailer_magic.data(), trailer_magic.size()) == 0;
  if (checked && !has_trailer)
    throw InputError(file.string() + ": not a Drumlin file, or cut short (no checksum at its end)");
  if (has_trailer) {
    const std::size_t size = bytes.size() - trailer_size;
    std::uint32_t stored = 0;
    for (int byte = 0; byte < 4; ++byte)
      stored |= std::uint32_t{static_cast<unsigned char>(bytes[size + 8 + byte])} << (8 * byte);
    if (stored != checksum({bytes.data(), size}))
      throw InputError(file.string() + ": damaged (checksum does not match)");
    bytes.resize(size);
  }
  const Id access{access_to_memory(), H5Pclose};
  H5FD_file_image_callbacks_t calls = callbacks_for(bytes);
  check(H5Pset_file_image_callbacks(access.get(), &calls) >= 0 &&
            H5Pset_file_image(access.get(), bytes.data(), bytes.size()) >= 0,
        "take a file image");
  handles_->file = std::make_unique<Id>(H5Fopen(image_name, H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!handles_->file->valid()) throw InputError(file.string() + ": not an HDF5 file");
}
H5Reader::~H5Reader() = default;

void H5Reader::refuse(const std::string& name, const std::string& what, const std::string& allowed) const {
  throw InputError({InputProblem{file_.string(), 0, 0, name, what, allowed}});
}

bool H5Reader::has(const std::string& name) const {
  // H5Lexists wants every group on the way to exist.
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    if (H5Lexists(handles_->file->get(), part.c_str(), H5P_DEFAULT) <= 0) return false;
    // Links lead anywhere: to other files, to other data, round in circles.
    if (is_soft_or_external_link(handles_->file->get(), part.c_str()))
      refuse(part, "a soft or external link (allowed: data that stand at this place)");
    if (end == std::string::npos) return true;
  }
}

std::vector<std::size_t> H5Reader::shape(const std::string& name) const {
  if (!has(name)) refuse(name, "missing dataset");
  const Id set(H5Dopen2(handles_->file->get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) refuse(name, "not a dataset");
  const Id space(H5Dget_space(set.get()), H5Sclose);
  const int dimensions = H5Sget_simple_extent_ndims(space.get());
  if (dimensions < 0) refuse(name, "of an impossible shape");
  std::vector<hsize_t> lengths(static_cast<std::size_t>(dimensions));
  H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr);
  return {lengths.begin(), lengths.end()};
}

namespace {

template <class T>
std::vector<T> read_set(const H5Reader& reader, hid_t file, const std::string& name, hid_t type,
                        H5T_class_t wanted) {
  if (!reader.has(name)) reader.refuse(name, "missing dataset");
  const Id set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) reader.refuse(name, "not a dataset");
  const Id stored(H5Dget_type(set.get()), H5Tclose);
  const H5T_class_t found = H5Tget_class(stored.get());
  if (found != wanted && !(wanted == H5T_FLOAT && found == H5T_INTEGER))
    reader.refuse(name, "of an unexpected type");
  const Id space(H5Dget_space(set.get()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (const char* fault = storage_fault(set.get(), stored.get(), count)) reader.refuse(name, fault);
  std::vector<T> values(static_cast<std::size_t>(count));
  if (count > 0 && H5Dread(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
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
std::string H5Reader::text(const std::string& name) const {
  const auto bytes =
      read_set<unsigned char>(*this, handles_->file->get(), name, H5T_NATIVE_UINT8, H5T_INTEGER);
  return {bytes.begin(), bytes.end()};
}

}  // namespace drumlin
