#include "particles/stepping/contact_memory.hpp"

namespace drumlin::particles {
namespace {

/// What turns an impulse that is remembered into one of a step of length `time_step`.
double scale_of(const ContactMemory& memory, double time_step) {
  return memory.time_step > 0 ? time_step / memory.time_step : 1;
}

}  // namespace

void Recollection::find(const ContactMemory& memory, std::size_t bodies, std::span<const Candidate> pairs) {
  const std::size_t contacts = memory.i.size();
  row_.assign(bodies + 1, 0);
  for (const std::int32_t i : memory.i) ++row_[i + 1];
  for (std::size_t b = 0; b < bodies; ++b) row_[b + 1] += row_[b];
  entries_.resize(contacts);
  for (std::size_t m = 0; m < contacts; ++m)  // a row ends up where the next one begins
    entries_[row_[memory.i[m]]++] = {memory.j[m], static_cast<std::int32_t>(m)};
  find_again(pairs);
}

void Recollection::find_again(std::span<const Candidate> pairs) {
  place_.resize(pairs.size());
  loops_.each(pairs.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      const std::int32_t i = pairs[a].i, j = pairs[a].j;
      const Entry* entry = entries_.data() + (i == 0 ? 0 : row_[i - 1]);
      const Entry* const row_end = entries_.data() + row_[i];
      while (entry < row_end && entry->j != j) ++entry;
      place_[a] = entry < row_end ? entry->place : -1;
    }
  });
}

RememberedLoads Recollection::loads(const ContactMemory& memory, int dim, double time_step) const {
  return {place_, memory.impulse, dim, scale_of(memory, time_step)};
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
