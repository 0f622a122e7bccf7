#include "coupling/core/hdf5/h5_storage.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>

namespace drumlin {
namespace {

constexpr std::int64_t largest_set = std::int64_t{1}
                                     << 28;     // numbers; a run of a million grains has far fewer
constexpr std::size_t largest_number = 16;      // bytes of a long double
constexpr std::uint64_t most_packed = 1032;     // bytes that deflate makes of one, at best
constexpr std::uint64_t small_chunk = 1 << 20;  // bytes; HDF5's own cache takes as much

bool has_only_own_filters(hid_t creation) {
  constexpr std::array own{H5Z_FILTER_DEFLATE, H5Z_FILTER_SHUFFLE, H5Z_FILTER_FLETCHER32};
  for (int i = 0; i < H5Pget_nfilters(creation); ++i) {
    unsigned flags = 0, configuration = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr,
                                               0, nullptr, &configuration);
    if (std::find(own.begin(), own.end(), filter) == own.end()) return false;
  }
  return true;
}

/// Bytes that one chunk fills in memory, at most the largest number there is.
std::uint64_t chunk_bytes(hid_t creation, std::size_t number) {
  std::array<hsize_t, H5S_MAX_RANK> lengths{};
  const int dimensions = H5Pget_chunk(creation, H5S_MAX_RANK, lengths.data());
  long double bytes = static_cast<long double>(number);
  for (int i = 0; i < dimensions; ++i)
    bytes *= static_cast<long double>(lengths[static_cast<std::size_t>(i)]);
  return bytes < 1e18L ? static_cast<std::uint64_t>(bytes) : UINT64_MAX;
}

/// Of an open creation list.
const char* layout_fault(hid_t set, hid_t creation, std::uint64_t number, std::uint64_t wanted) {
  const H5D_layout_t layout = H5Pget_layout(creation);
  if (layout == H5D_VIRTUAL || H5Pget_external_count(creation) > 0) return "stored in another file";
  if (!has_only_own_filters(creation)) return "packed by a filter that is not read here";
  const bool packed = H5Pget_nfilters(creation) > 0;
  const std::uint64_t stored = H5Dget_storage_size(set);
  const std::uint64_t at_most = packed ? stored * most_packed : stored;
  if (wanted > at_most) return "of more numbers than the file holds";
  if (layout == H5D_CHUNKED && chunk_bytes(creation, number) > std::max(at_most, small_chunk))
    return "cut into pieces that are larger than what the file holds";
  return nullptr;
}

}  // namespace

bool is_soft_or_external_link(std::int64_t file, const char* name) {
  H5L_info_t link{};
  return H5Lget_info(file, name, &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD;
}

const char* storage_fault(std::int64_t set, std::int64_t type, std::int64_t count) {
  const std::size_t number = H5Tget_size(type);
  if (count < 0 || count > largest_set) return "of an impossible size";
  const bool words = H5Tget_class(type) == H5T_STRING;
  if (number == 0 || (number > largest_number && !words)) return "of numbers of an impossible size";
  if (count == 0) return nullptr;
  const hid_t creation = H5Dget_create_plist(set);
  if (creation < 0) return "unreadable";
  const char* fault = layout_fault(set, creation, number, static_cast<std::uint64_t>(count) * number);
  H5Pclose(creation);
  return fault;
}

}  // namespace drumlin
