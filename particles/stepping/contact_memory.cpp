#include "particles/stepping/contact_memory.hpp"

#include <algorithm>

#include "particles/detection/open_gaps.hpp"

namespace drumlin::particles {
namespace {

/// What turns an impulse that is remembered into one of a step of length `time_step`.
double scale_of(const ContactMemory& memory, double time_step) {
  return memory.time_step > 0 ? time_step / memory.time_step : 1;
}

/// Where the row of each key from `least` up to `bodies` begins in a list sorted by keys. Once each entry has
/// been put at the beginning of its row, and that has moved on by one, they are the ends.
void count_rows(std::span<const std::int32_t> keys, std::int32_t least, std::size_t bodies,
                WorkArray<std::int32_t>& begin) {
  const std::size_t rows = bodies - least;
  begin.assign(rows + 1, 0);
  for (const std::int32_t key : keys) ++begin[key - least + 1];
  for (std::size_t row = 1; row <= rows; ++row) begin[row] += begin[row - 1];
}

}  // namespace

void Recollection::find(const ContactMemory& memory, std::size_t bodies, std::span<const Candidate> pairs) {
  sort_entries(memory, bodies);
  find_again(pairs);
}

/// By i, and by j within each i: two counting sorts, the later key first.
void Recollection::sort_entries(const ContactMemory& memory, std::size_t bodies) {
  const std::size_t contacts = memory.i.size();
  const std::int32_t least =
      contacts > 0 ? std::min(0, *std::min_element(memory.j.begin(), memory.j.end())) : 0;
  count_rows(memory.j, least, bodies, row_end_);
  by_second_.renew(contacts);
  for (std::size_t m = 0; m < contacts; ++m)
    by_second_[row_end_[memory.j[m] - least]++] = static_cast<std::int32_t>(m);
  count_rows(memory.i, 0, bodies, row_end_);
  entries_.renew(contacts);
  for (const std::int32_t m : by_second_) entries_[row_end_[memory.i[m]]++] = {memory.j[m], m};
}

void Recollection::find_again(std::span<const Candidate> pairs) {
  place_.renew(pairs.size());
  loops_.each(pairs.size(), [&](std::size_t begin, std::size_t end) {
    const Entry* entry = nullptr;
    const Entry* row_end = nullptr;
    for (std::size_t a = begin; a < end; ++a) {
      const std::int32_t i = pairs[a].i, j = pairs[a].j;
      if (a == begin || i != pairs[a - 1].i || j <= pairs[a - 1].j) {
        entry = row(i).data();
        row_end = entry + row(i).size();
      }
      // Pairs that follow in the order of (i, j), as most do, go on from here: nearly every one is the next.
      while (entry < row_end && entry->j < j) ++entry;
      const bool known = entry < row_end && entry->j == j;
      place_[a] = known ? entry->place : -1;
      entry += known;
    }
  });
}

std::span<const Recollection::Entry> Recollection::row(std::int32_t i) const {
  const std::int32_t begin = i == 0 ? 0 : row_end_[i - 1];
  return {entries_.data() + begin, entries_.data() + row_end_[i]};
}

std::int32_t Recollection::place_of(const Candidate& pair) const {
  for (const Entry& entry : row(pair.i))
    if (entry.j == pair.j) return entry.place;
  return -1;
}

void Recollection::find_added(std::span<const Candidate> pairs, std::span<const std::int32_t> added) {
  open_gaps(place_, added.size(), [&](std::size_t k, std::size_t) { return added[k]; });
  for (const std::int32_t a : added) place_[a] = place_of(pairs[a]);
}

RememberedLoads Recollection::loads(const ContactMemory& memory, int dim, double time_step) const {
  return {{place_.data(), place_.size()}, memory.impulse, dim, scale_of(memory, time_step)};
}

RememberedLoads Recollection::loads_of(std::span<const Candidate> pairs, const ContactMemory& memory, int dim,
                                       double time_step) {
  place_of_some_.clear();
  for (const Candidate& pair : pairs) place_of_some_.push_back(place_of(pair));
  return {place_of_some_, memory.impulse, dim, scale_of(memory, time_step)};
}

void Recollection::warm_start(const ContactMemory& memory, int dim, double time_step,
                              std::span<const std::int32_t> order, std::vector<double>& impulses) const {
  impulses.clear();
  resize_closely(impulses, dim * place_.size());
  const double scale = scale_of(memory, time_step);
  loops_.each(place_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a)
      if (const std::int32_t m = place_[order[a]]; m >= 0)
        for (int c = 0; c < dim; ++c) impulses[dim * a + c] = scale * memory.impulse[dim * m + c];
  });
}

void remember(std::span<const Candidate> pairs, const std::vector<double>& impulses, double time_step,
              ContactMemory& memory) {
  memory.time_step = time_step;
  resize_closely(memory.i, pairs.size());
  resize_closely(memory.j, pairs.size());
  for (std::size_t a = 0; a < pairs.size(); ++a) memory.i[a] = pairs[a].i, memory.j[a] = pairs[a].j;
  resize_closely(memory.impulse, impulses.size());
  std::copy(impulses.begin(), impulses.end(), memory.impulse.begin());
}

}  // namespace drumlin::particles
