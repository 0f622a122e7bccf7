#include "particles/solver/coarse_loads.hpp"

#include <algorithm>
#include <cmath>

#include "particles/solver/strip_solver.hpp"

namespace drumlin::particles {
namespace {

/// A distance along x or z; added up, the longest.
struct Longest {
  double distance = 0;
  void add(const Longest& other) { distance = std::max(distance, other.distance); }
};

double longest_contact(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                       const BodyPlaces& places, const ParallelLoops& loops) {
  const auto fixed = static_cast<std::int32_t>(places.x.size());
  return loops
      .combined<Longest>(i.size(),
                         [&](std::size_t begin, std::size_t end) {
                           Longest own;
                           for (std::size_t a = begin; a < end; ++a) {
                             if (j[a] == fixed) continue;
                             own.add({std::abs(places.x[i[a]] - places.x[j[a]])});
                             own.add({std::abs(places.z[i[a]] - places.z[j[a]])});
                           }
                           return own;
                         })
      .distance;
}

}  // namespace

template <class T, class Law, bool spin>
void CoarseLoads::lay_out(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                          const BodyPlaces& places, const StripProblem<T, Law, spin>& strips,
                          const ParallelLoops& loops) {
  const auto [x_low, x_high] = std::minmax_element(places.x.begin(), places.x.end());
  const auto [z_low, z_high] = std::minmax_element(places.z.begin(), places.z.end());
  grid_ = field_grid({*x_low, *x_high, *z_low, *z_high}, static_cast<std::int64_t>(i.size()),
                     longest_contact(i, j, places, loops));
  auto& own = records_.of<T>();
  own.make(strips.bodies().size());
  const auto record = strips.record();
  loops.each(record.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) own.place(record[b], places.x[b], places.z[b], grid_);
  });
}

/// The contacts of a phase of a strip.
template <class T, class Law, bool spin>
void CoarseLoads::add_contacts(StripProblem<T, Law, spin>& strips, int strip, int phase) {
  const auto blocks = strips.blocks(strip, phase);
  CoarseKernels<T, Law, spin>::add_contacts(blocks.data(), blocks.size(), strips.bodies().data(),
                                            records_.of<T>().bodies());
}

/// The bodies of a strip. Most of those in a row are in one cell: their terms are added up before they go to
/// the nodes.
template <class T, class Law, bool spin>
void CoarseLoads::add_bodies(const StripProblem<T, Law, spin>& strips, int strip, int part) {
  const auto [begin, end] = strips.records(strip);
  double *const rows = &rows_[part * this->rows()],
                *const work = &work_[part * static_cast<std::size_t>(grid_.nodes())];
  const auto to_nodes = [&](const CoarseTerms<T>& terms, std::size_t b, int cell) {
    each_coarse_term(
        grid_, terms, b, cell,
        [&](int node, int entry, T energy) { rows[entries_of_node * node + entry] += energy; },
        [&](int node, T power) { work[node] += power; });
  };
  CoarseTerms<T> sums{};
  int cell_of_sums = -1;
  const auto end_sums = [&] {
    if (cell_of_sums >= 0)
      for (std::size_t b = 0; b < sums.width; ++b) to_nodes(sums, b, cell_of_sums);
    cell_of_sums = -1;
  };
  each_coarse_terms(grid_, strips.bodies().data(), records_.of<T>().bodies(), begin, end - begin,
                    [&](const CoarseTerms<T>& terms, std::span<const int> cells) {
                      const bool together =
                          cells.size() == terms.width &&
                          std::all_of(cells.begin(), cells.end(), [&](int cell) { return cell == cells[0]; });
                      if (!together) {
                        for (std::size_t b = 0; b < cells.size(); ++b) to_nodes(terms, b, cells[b]);
                        return;
                      }
                      if (cells[0] != cell_of_sums)
                        end_sums(), sums = terms;
                      else
                        sums.add(terms);
                      cell_of_sums = cells[0];
                    });
  end_sums();
}

template <class T, class Law, bool spin>
void CoarseLoads::exchange(StripProblem<T, Law, spin>& strips, int phase) {
  auto& own = records_.of<T>();
  for (auto* records : {&own.at, &own.along_x, &own.along_z}) strips.exchange(phase, *records);
}

/// Strip by strip, as long as what a strip moves is in the caches. The second slice of a part's last strip
/// touches the first one of the next part, and waits until the parts are done.
template <class T, class Law, bool spin>
void CoarseLoads::add_up(StripProblem<T, Law, spin>& strips, const ParallelLoops& loops) {
  const auto [first_part, end_part] = strips.own_parts();
  const auto rest = [&](int strip) {
    const auto [begin, end] = strips.records(strip);
    records_.of<T>().rest(begin, end);
  };
  const auto each_part = [&, first = first_part, parts = end_part - first_part](auto work) {
    loops.each_of(parts, [&](int k) { work(first + k); });
  };
  each_part([&](int part) {
    const int begin = strips.first_of(part), end = strips.first_of(part + 1);
    if (begin < end) rest(begin);
    for (int k = begin; k < end; ++k) {
      add_contacts(strips, k, 0);
      if (k + 1 == end) break;
      rest(k + 1);
      add_contacts(strips, k, 1);
      if (k > begin) add_bodies(strips, k, part);
    }
  });
  exchange(strips, 0);
  for (int part = first_part; part < end_part; ++part)
    if (const int last = strips.first_of(part + 1) - 1; last >= strips.first_of(part))
      add_contacts(strips, last, 1);
  exchange(strips, 1);
  each_part([&](int part) {
    const int begin = strips.first_of(part), last = strips.first_of(part + 1) - 1;
    if (last >= begin) add_bodies(strips, begin, part);
    if (last > begin) add_bodies(strips, last, part);
  });
  strips.gather_parts(work_, grid_.nodes());
  strips.gather_parts(rows_, rows());
}

/// Solves for the field; empty where the matrix or the result is no good.
std::vector<double> CoarseLoads::solve() const {
  std::vector<double> right(grid_.nodes(), 0.0), rows(this->rows(), 0.0);
  for (std::size_t k = 0; k < work_.size(); ++k) right[k % right.size()] -= work_[k];
  for (std::size_t e = 0; e < rows_.size(); ++e) rows[e % rows.size()] += rows_[e];
  return solve_field(grid_, rows, right);
}

template <class T, class Law, bool spin>
bool CoarseLoads::scale(StripProblem<T, Law, spin>& strips, const ParallelLoops& loops) {
  constexpr std::size_t parts = StripProblem<T, Law, spin>::parts;
  work_.assign(parts * grid_.nodes(), 0.0);
  rows_.assign(parts * rows(), 0.0);
  add_up(strips, loops);
  const std::vector<double> field = solve();
  if (field.empty()) return false;
  auto& own = records_.of<T>();
  const auto [first, last] = strips.own();
  // The last strip's contacts touch bodies of the next one.
  loops.each_of(std::min(last + 1, strips.strips()) - first, [&, first = first](int k) {
    const auto [begin, end] = strips.records(first + k);
    own.set_factors(begin, end, grid_, field);
  });
  loops.each_of(last - first, [&, first = first](int k) {
    for (const int phase : {0, 1}) {
      const auto blocks = strips.blocks(first + k, phase);
      CoarseKernels<T, Law, spin>::scale(blocks.data(), blocks.size(), own.at.data());
    }
  });
  return true;
}

#define DRUMLIN_INSTANTIATE_IN(T, Law, spin)                                                       \
  template bool CoarseLoads::scale(StripProblem<T, Law, spin>&, const ParallelLoops&);             \
  template void CoarseLoads::lay_out(std::span<const std::int32_t>, std::span<const std::int32_t>, \
                                     const BodyPlaces&, const StripProblem<T, Law, spin>&,         \
                                     const ParallelLoops&);
#define DRUMLIN_INSTANTIATE(Problem, Law, spin) \
  DRUMLIN_INSTANTIATE_IN(float, Law, spin) DRUMLIN_INSTANTIATE_IN(double, Law, spin)
DRUMLIN_EACH_PLAIN_PROBLEM(DRUMLIN_INSTANTIATE)
#undef DRUMLIN_INSTANTIATE
#undef DRUMLIN_INSTANTIATE_IN

}  // namespace drumlin::particles
