#include "particles/stepping/contact_memory.hpp"

#include <algorithm>

namespace drumlin::particles {
namespace {

/// What turns an impulse that is remembered into one of a step of length `time_step`.
double scale_of(const ContactMemory& memory, double time_step) {
  return memory.time_step > 0 ? time_step / memory.time_step : 1;
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
  row_.assign(bodies - least + 1, 0);
  for (const std::int32_t j : memory.j) ++row_[j - least + 1];
  for (std::size_t r = 1; r < row_.size(); ++r) row_[r] += row_[r - 1];
  by_second_.resize(contacts);
  for (std::size_t m = 0; m < contacts; ++m)
    by_second_[row_[memory.j[m] - least]++] = static_cast<std::int32_t>(m);
  row_.assign(bodies + 1, 0);
  for (const std::int32_t i : memory.i) ++row_[i + 1];
  for (std::size_t b = 0; b < bodies; ++b) row_[b + 1] += row_[b];
  entries_.resize(contacts);
  for (const std::int32_t m : by_second_)  // a row ends up where the next one begins
    entries_[row_[memory.i[m]]++] = {memory.j[m], m};
}

void Recollection::find_again(std::span<const Candidate> pairs) {
  place_.resize(pairs.size());
  loops_.each(pairs.size(), [&](std::size_t begin, std::size_t end) {
    const Entry* entry = nullptr;
    const Entry* row_end = nullptr;
    for (std::size_t a = begin; a < end; ++a) {
      const std::int32_t i = pairs[a].i, j = pairs[a].j;
      if (a == begin || i != pairs[a - 1].i || j <= pairs[a - 1].j) {
        entry = entries_.data() + (i == 0 ? 0 : row_[i - 1]);
        row_end = entries_.data() + row_[i];
      }
      // Pairs that follow in the order of (i, j), as most do, go on from here: nearly every one is the next.
      while (entry < row_end && entry->j < j) ++entry;
      const bool known = entry < row_end && entry->j == j;
      place_[a] = known ? entry->place : -1;
      entry += known;
    }
  });
}

std::int32_t Recollection::place_of(const Candidate& pair) const {
  const Entry* const begin = entries_.data() + (pair.i == 0 ? 0 : row_[pair.i - 1]);
  const Entry* const end = entries_.data() + row_[pair.i];
  const Entry* const found = std::find_if(begin, end, [&](const Entry& e) { return e.j == pair.j; });
  return found < end ? found->place : -1;
}

void Recollection::find_added(std::span<const Candidate> pairs, std::span<const std::int32_t> added) {
  std::size_t end = place_.size();
  place_.resize(pairs.size());
  for (std::size_t left = added.size(); left > 0; --left) {
    const std::size_t a = added[left - 1];
    std::move_backward(place_.begin() + (a - left + 1), place_.begin() + end, place_.begin() + end + left);
    end = a - left + 1;
    place_[a] = place_of(pairs[a]);
  }
}

RememberedLoads Recollection::loads(const ContactMemory& memory, int dim, double time_step) const {
  return {place_, memory.impulse, dim, scale_of(memory, time_step)};
}

RememberedLoads Recollection::loads_of(std::span<const Candidate> pairs, const ContactMemory& memory, int dim,
                                       double time_step) {
  place_of_some_.clear();
  for (const Candidate& pair : pairs) place_of_some_.push_back(place_of(pair));
  return {place_of_some_, memory.impulse, dim, scale_of(memory, time_step)};
}

void Recollection::warm_start(const ContactMemory& memory, int dim, double time_step,
                              std::span<const std::int32_t> order, std::vector<double>& impulses) const {
  impulses.assign(dim * place_.size(), 0.0);
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
  memory.i.resize(pairs.size());
  memory.j.resize(pairs.size());
  for (std::size_t a = 0; a < pairs.size(); ++a) memory.i[a] = pairs[a].i, memory.j[a] = pairs[a].j;
  memory.impulse = impulses;
}

}  // namespace drumlin::particles
