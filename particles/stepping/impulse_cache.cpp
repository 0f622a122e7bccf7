#include "particles/stepping/impulse_cache.hpp"

#include <algorithm>
#include <utility>

#include "particles/detection/open_gaps.hpp"

namespace drumlin::particles {
namespace {

/// What turns an impulse that is remembered into one of a step of length `time_step`.
double scale_of(const ImpulseCache& memory, double time_step) {
  return memory.time_step > 0 ? time_step / memory.time_step : 1;
}

/// Pairs in the order of (i, j) are in the order of these numbers.
std::int64_t key_of(std::int32_t i, std::int32_t j) { return (std::int64_t{i} << 32) + j; }

/// The first contact that is not before a pair.
std::size_t first_from(const ImpulseCache& memory, std::int64_t key) {
  std::size_t first = 0;
  for (std::size_t count = memory.i.size(); count > 0;) {
    const std::size_t half = count / 2;
    const bool before = key_of(memory.i[first + half], memory.j[first + half]) < key;
    first = before ? first + half + 1 : first;
    count = before ? count - half - 1 : half;
  }
  return first;
}

/// Position of a pair in the memory; -1: none.
std::int32_t place_of(const ImpulseCache& memory, const Candidate& pair) {
  const std::size_t m = first_from(memory, key_of(pair.i, pair.j));
  return m < memory.i.size() && memory.i[m] == pair.i && memory.j[m] == pair.j ? static_cast<std::int32_t>(m)
                                                                               : -1;
}

bool in_order(const ImpulseCache& memory) {
  for (std::size_t m = 1; m < memory.i.size(); ++m)
    if (key_of(memory.i[m - 1], memory.j[m - 1]) > key_of(memory.i[m], memory.j[m])) return false;
  return true;
}

/// Positions in the order of their keys, and of `positions` among equal ones: a counting sort.
std::vector<std::int32_t> sorted_by(std::span<const std::int32_t> keys,
                                    std::span<const std::int32_t> places) {
  const auto [least, largest] = std::minmax_element(keys.begin(), keys.end());
  std::vector<std::int32_t> begin(*largest - *least + 2, 0), sorted(places.size());
  for (const std::int32_t key : keys) ++begin[key - *least + 1];
  for (std::size_t row = 1; row < begin.size(); ++row) begin[row] += begin[row - 1];
  for (const std::int32_t m : places) sorted[begin[keys[m] - *least]++] = m;
  return sorted;
}

}  // namespace

bool was_loaded(const ImpulseCache& memory, const Candidate& pair) {
  const auto [first, last] = std::equal_range(memory.i.begin(), memory.i.end(), pair.i);
  const auto begin = memory.j.begin() + (first - memory.i.begin()),
             end = memory.j.begin() + (last - memory.i.begin());
  return std::binary_search(begin, end, pair.j);
}

void put_in_order(ImpulseCache& memory) {
  const std::size_t contacts = memory.i.size();
  if (in_order(memory)) return;
  std::vector<std::int32_t> places(contacts);
  for (std::size_t m = 0; m < contacts; ++m) places[m] = static_cast<std::int32_t>(m);
  places = sorted_by(memory.i, sorted_by(memory.j, places));  // the later key first
  const std::size_t dim = memory.impulse.size() / contacts;
  ImpulseCache sorted;
  sorted.time_step = memory.time_step;
  sorted.i.reserve(contacts), sorted.j.reserve(contacts), sorted.impulse.reserve(memory.impulse.size());
  for (const std::int32_t m : places) {
    sorted.i.push_back(memory.i[m]), sorted.j.push_back(memory.j[m]);
    for (std::size_t c = 0; c < dim; ++c) sorted.impulse.push_back(memory.impulse[dim * m + c]);
  }
  memory = std::move(sorted);
}

void WarmStarts::find(const ImpulseCache& memory, std::span<const Candidate> pairs) {
  place_.resize_uninitialized(pairs.size());
  std::int32_t* const place = place_.data();
  loops_.each(pairs.size(), [&, contacts = memory.i.size()](std::size_t begin, std::size_t end) {
    std::size_t m = 0;
    for (std::size_t a = begin; a < end; ++a) {
      const std::int64_t key = key_of(pairs[a].i, pairs[a].j);
      if (a == begin || key <= key_of(pairs[a - 1].i, pairs[a - 1].j)) m = first_from(memory, key);
      while (m < contacts && key_of(memory.i[m], memory.j[m]) < key) ++m;
      const bool known = m < contacts && key_of(memory.i[m], memory.j[m]) == key;
      place[a] = known ? static_cast<std::int32_t>(m) : -1;
    }
  });
}

void WarmStarts::find_added(const ImpulseCache& memory, std::span<const std::int32_t> added,
                            std::span<const Candidate> pairs_added) {
  open_gaps(place_, added.size(), [&](std::size_t k, std::size_t) { return added[k]; });
  for (std::size_t k = 0; k < added.size(); ++k) place_[added[k]] = place_of(memory, pairs_added[k]);
}

SavedLoads WarmStarts::loads(const ImpulseCache& memory, int dim, double time_step) const {
  return {{place_.data(), place_.size()}, memory.impulse, dim, scale_of(memory, time_step)};
}

void WarmStarts::warm_start(const ImpulseCache& memory, int dim, double time_step,
                            std::span<const std::int32_t> order, std::vector<double>& impulses) const {
  resize_closely(impulses, dim * place_.size());
  const double scale = scale_of(memory, time_step);
  const std::int32_t* const place = place_.data();
  loops_.each(place_.size(), [&](std::size_t begin, std::size_t end) {
    double* to = impulses.data() + dim * begin;
    for (std::size_t a = begin; a < end; ++a) {
      const std::int32_t m = place[order[a]];
      for (int c = 0; c < dim; ++c) *to++ = m < 0 ? 0 : scale * memory.impulse[dim * m + c];
    }
  });
}

void save_contacts(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                   std::span<const std::int32_t> order, const std::vector<double>& impulses, double time_step,
                   const ParallelLoops& loops, ImpulseCache& memory) {
  memory.time_step = time_step;
  resize_closely(memory.i, i.size());
  resize_closely(memory.j, j.size());
  resize_closely(memory.impulse, impulses.size());
  std::copy(i.begin(), i.end(), memory.i.begin());
  std::copy(j.begin(), j.end(), memory.j.begin());
  const std::size_t dim = i.empty() ? 0 : impulses.size() / i.size();
  loops.each(i.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a)
      for (std::size_t c = 0; c < dim; ++c) memory.impulse[dim * order[a] + c] = impulses[dim * a + c];
  });
}

}  // namespace drumlin::particles
