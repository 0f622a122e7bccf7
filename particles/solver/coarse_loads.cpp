#include "particles/solver/coarse_loads.hpp"

#include <algorithm>
#include <cmath>

#include "particles/solver/coarse_moves.hpp"
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

void CoarseLoads::lay_out(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                          const BodyPlaces& places, std::span<const std::int32_t> record, std::size_t records,
                          const TeamLoops& loops) {
  const auto [x_low, x_high] = std::minmax_element(places.x.begin(), places.x.end());
  const auto [z_low, z_high] = std::minmax_element(places.z.begin(), places.z.end());
  grid_ = field_grid({*x_low, *x_high, *z_low, *z_high}, static_cast<std::int64_t>(i.size()),
                     longest_contact(i, j, places, loops));
  places_.renew(records);
  moves_.renew(records);
  loops.each(record.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) places_[record[b]] = grid_.place_at(places.x[b], places.z[b]);
  });
}

/// The contacts of a phase of a strip.
template <class T, int dim, bool spin>
void CoarseLoads::add_contacts(StripProblem<T, dim, spin>& strips, int strip, int phase,
                               std::vector<double>& work) {
  const auto* const bodies = strips.bodies().data();
  for (const auto& block : strips.blocks(strip, phase))
    for (int k = 0; k < block.width; ++k) {
      if (!(block.r[0][k] > 0)) continue;
      const CoarseContact<T, dim, spin> contact(block, k);
      const double power = contact.power(block, k, bodies);
      const NodePlace& at = places_[contact.i];
      const auto weights = at.weights();
      for (const int corner : {0, 1, 2, 3}) work[grid_.corner(at, corner)] += weights[corner] * power;
      contact.move(places_.data(), bodies, moves_.data());
    }
}

/// The bodies of a strip.
template <class T, int dim, bool spin>
void CoarseLoads::add_bodies(const StripProblem<T, dim, spin>& strips, int strip,
                             std::vector<double>& rows) const {
  const auto [begin, end] = strips.records(strip);
  for (std::size_t b = begin; b < end; ++b)
    if (const double inverse_mass = strips.bodies()[b].inverse_mass; inverse_mass > 0)
      each_product(grid_, places_[b], moves_[b], 1 / inverse_mass, [&](int node, int entry, double energy) {
        rows[entries_of_node * node + entry] += energy;
      });
}

/// Strip by strip, as long as what a strip moves is in the caches. The second slice of a part's last strip
/// touches the first one of the next part, and waits until the parts are done.
template <class T, int dim, bool spin>
void CoarseLoads::add_up(StripProblem<T, dim, spin>& strips, const TeamLoops& loops) {
  const auto rest = [&](int strip) {
    const auto [begin, end] = strips.records(strip);
    std::fill(moves_.begin() + begin, moves_.begin() + end, NodeMoves{});
  };
  const auto first_of = [&](int part) { return strips.strips() * part / parts; };
  loops.each_of(parts, [&](int part) {
    const int begin = first_of(part), end = first_of(part + 1);
    if (begin < end) rest(begin);
    for (int k = begin; k < end; ++k) {
      add_contacts(strips, k, 0, work_[part]);
      if (k + 1 == end) break;
      rest(k + 1);
      add_contacts(strips, k, 1, work_[part]);
      if (k > begin) add_bodies(strips, k, rows_[part]);
    }
  });
  for (int part = 0; part < parts; ++part)
    if (const int last = first_of(part + 1) - 1; last >= first_of(part))
      add_contacts(strips, last, 1, work_[part]);
  loops.each_of(parts, [&](int part) {
    const int begin = first_of(part), last = first_of(part + 1) - 1;
    if (last >= begin) add_bodies(strips, begin, rows_[part]);
    if (last > begin) add_bodies(strips, last, rows_[part]);
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
  loops.each_of(strips.strips(), [&](int strip) {
    for (const int phase : {0, 1}) scale_blocks(strips.blocks(strip, phase), grid_, places_.data(), field);
  });
  return true;
}

template bool CoarseLoads::scale(StripProblem<float, 1, false>&, const TeamLoops&);
template bool CoarseLoads::scale(StripProblem<float, 2, false>&, const TeamLoops&);
template bool CoarseLoads::scale(StripProblem<float, 2, true>&, const TeamLoops&);
template bool CoarseLoads::scale(StripProblem<double, 1, false>&, const TeamLoops&);
template bool CoarseLoads::scale(StripProblem<double, 2, false>&, const TeamLoops&);
template bool CoarseLoads::scale(StripProblem<double, 2, true>&, const TeamLoops&);

}  // namespace drumlin::particles
