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
                       const BodyPlaces& places, const TeamLoops& loops) {
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

template <class T, int dim, bool spin>
void CoarseLoads::lay_out(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                          const BodyPlaces& places, const StripProblem<T, dim, spin>& strips,
                          const TeamLoops& loops) {
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
template <class T, int dim, bool spin>
void CoarseLoads::add_contacts(StripProblem<T, dim, spin>& strips, int strip, int phase) {
  const auto blocks = strips.blocks(strip, phase);
  CoarseKernels<T, dim, spin>::add_contacts(blocks.data(), blocks.size(), strips.bodies().data(),
                                            records_.of<T>().bodies());
}

/// The bodies of a strip. Most of those in a row are in one cell: their terms are added up before they go to
/// the nodes.
template <class T, int dim, bool spin>
void CoarseLoads::add_bodies(const StripProblem<T, dim, spin>& strips, int strip, int part) {
  const auto [begin, end] = strips.records(strip);
  auto &rows = rows_[part], &work = work_[part];
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

/// Strip by strip, as long as what a strip moves is in the caches. The second slice of a part's last strip
/// touches the first one of the next part, and waits until the parts are done.
template <class T, int dim, bool spin>
void CoarseLoads::add_up(StripProblem<T, dim, spin>& strips, const TeamLoops& loops) {
  const auto rest = [&](int strip) {
    const auto [begin, end] = strips.records(strip);
    records_.of<T>().rest(begin, end);
  };
  const auto first_of = [&](int part) { return strips.strips() * part / parts; };
  loops.each_of(parts, [&](int part) {
    const int begin = first_of(part), end = first_of(part + 1);
    if (begin < end) rest(begin);
    for (int k = begin; k < end; ++k) {
      add_contacts(strips, k, 0);
      if (k + 1 == end) break;
      rest(k + 1);
      add_contacts(strips, k, 1);
      if (k > begin) add_bodies(strips, k, part);
    }
  });
  for (int part = 0; part < parts; ++part)
    if (const int last = first_of(part + 1) - 1; last >= first_of(part)) add_contacts(strips, last, 1);
  loops.each_of(parts, [&](int part) {
    const int begin = first_of(part), last = first_of(part + 1) - 1;
    if (last >= begin) add_bodies(strips, begin, part);
    if (last > begin) add_bodies(strips, last, part);
  });
}

/// Solves for the field; empty where the matrix or the result is no good.
std::vector<double> CoarseLoads::solve() const {
  std::vector<double> right(grid_.nodes(), 0.0), rows = rows_[0];
  for (const auto& work : work_)
    for (std::size_t k = 0; k < right.size(); ++k) right[k] -= work[k];
  for (int part = 1; part < parts; ++part)
    for (std::size_t e = 0; e < rows.size(); ++e) rows[e] += rows_[part][e];
  return solve_field(grid_, rows, right);
}

template <class T, int dim, bool spin>
bool CoarseLoads::scale(StripProblem<T, dim, spin>& strips, const TeamLoops& loops) {
  for (auto& work : work_) work.assign(grid_.nodes(), 0.0);
  for (auto& rows : rows_) rows.assign(static_cast<std::size_t>(entries_of_node) * grid_.nodes(), 0.0);
  add_up(strips, loops);
  const std::vector<double> field = solve();
  if (field.empty()) return false;
  auto& own = records_.of<T>();
  loops.each_of(strips.strips(), [&](int strip) {
    const auto [begin, end] = strips.records(strip);
    own.set_factors(begin, end, grid_, field);
  });
  loops.each_of(strips.strips(), [&](int strip) {
    for (const int phase : {0, 1}) {
      const auto blocks = strips.blocks(strip, phase);
      CoarseKernels<T, dim, spin>::scale(blocks.data(), blocks.size(), own.at.data());
    }
  });
  return true;
}

#define DRUMLIN_INSTANTIATE(T, dim, spin)                                                          \
  template bool CoarseLoads::scale(StripProblem<T, dim, spin>&, const TeamLoops&);                 \
  template void CoarseLoads::lay_out(std::span<const std::int32_t>, std::span<const std::int32_t>, \
                                     const BodyPlaces&, const StripProblem<T, dim, spin>&,         \
                                     const TeamLoops&);
DRUMLIN_INSTANTIATE(float, 1, false)
DRUMLIN_INSTANTIATE(float, 2, false)
DRUMLIN_INSTANTIATE(float, 2, true)
DRUMLIN_INSTANTIATE(double, 1, false)
DRUMLIN_INSTANTIATE(double, 2, false)
DRUMLIN_INSTANTIATE(double, 2, true)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
