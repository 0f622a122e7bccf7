#include "particles/solver/coarse_loads.hpp"

#include <algorithm>
#include <cmath>

#include "particles/solver/coarse_moves.hpp"

namespace drumlin::particles {
namespace {

/// A distance along x or z; added up, the longest.
struct Longest {
  double distance = 0;
  void add(const Longest& other) { distance = std::max(distance, other.distance); }
};

double longest_contact(const CoarseProblem& problem, const BodyPlaces& places, const TeamLoops& loops) {
  const auto fixed = static_cast<std::int32_t>(problem.inverse_mass.size()) - 1;
  return loops
      .combined<Longest>(problem.i.size(),
                         [&](std::size_t begin, std::size_t end) {
                           Longest own;
                           for (std::size_t a = begin; a < end; ++a) {
                             const std::int32_t i = problem.i[a], j = problem.j[a];
                             if (j == fixed) continue;
                             own.add({std::abs(places.x[i] - places.x[j])});
                             own.add({std::abs(places.z[i] - places.z[j])});
                           }
                           return own;
                         })
      .distance;
}

}  // namespace

void CoarseLoads::lay_out(const CoarseProblem& problem, const BodyPlaces& places, const TeamLoops& loops) {
  const auto [x_low, x_high] = std::minmax_element(places.x.begin(), places.x.end());
  const auto [z_low, z_high] = std::minmax_element(places.z.begin(), places.z.end());
  grid_ = field_grid({*x_low, *x_high, *z_low, *z_high}, static_cast<std::int64_t>(problem.i.size()),
                     longest_contact(problem, places, loops));
  rank_.renew(places.x.size());
  places_.renew(places.x.size());
  moves_.renew(places.x.size());
  loops.each(places_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t rank = begin; rank < end; ++rank) {
      const std::int32_t b = problem.plan.body_order[rank];
      rank_[b] = static_cast<std::int32_t>(rank);
      places_[rank] = {grid_.place_at(places.x[b], places.z[b]), problem.inverse_mass[b]};
    }
  });
}

/// The contacts of a slice.
void CoarseLoads::add_contacts(const CoarseProblem& problem, std::span<const double> u,
                               std::span<const double> r, int slice, std::vector<double>& work) {
  const SweepPlan& plan = problem.plan;
  const auto fixed = static_cast<std::int32_t>(problem.inverse_mass.size()) - 1;
  const std::int32_t end = plan.group_start[plan.slice_start[slice + 1]];
  for (std::int32_t a = plan.group_start[plan.slice_start[slice]]; a < end; ++a) {
    const double* const r_a = r.data() + static_cast<std::ptrdiff_t>(problem.dim) * a;
    const double* const u_a = u.data() + static_cast<std::ptrdiff_t>(problem.dim) * a;
    if (!(r_a[0] > 0)) continue;
    const bool rubs = problem.dim == 2;
    const double r_n = r_a[0], r_t = rubs ? r_a[1] : 0;
    const double g = power_of(r_n, u_a[0], r_t, rubs ? u_a[1] : 0, rubs ? problem.mu[a] : 0);
    const std::int32_t i = rank_[problem.i[a]];
    const Body& first = places_[i];
    const auto weights = first.place.weights();
    for (const int k : {0, 1, 2, 3}) work[grid_.corner(first.place, k)] += weights[k] * g;
    const NodePush push(problem.n_x[a], problem.n_z[a], r_n, r_t, problem.spin, first.place);
    push.add_to(moves_[i], first.place, first.inverse_mass, 1);
    if (problem.j[a] == fixed) continue;
    const std::int32_t j = rank_[problem.j[a]];
    push.add_to(moves_[j], places_[j].place, places_[j].inverse_mass, -1);
  }
}

/// The bodies of a strip.
void CoarseLoads::add_bodies(const CoarseProblem& problem, int strip, std::vector<double>& rows) const {
  const auto& first = problem.plan.strip_bodies;
  for (std::int32_t rank = first[strip]; rank < first[strip + 1]; ++rank)
    each_product(grid_, places_[rank].place, moves_[rank], 1 / places_[rank].inverse_mass,
                 [&](int node, int entry, double energy) { rows[entries_of_node * node + entry] += energy; });
}

/// Strip by strip, as long as what a strip moves is in the caches. The second slice of a part's last strip
/// touches the first one of the next part, and waits until the parts are done.
void CoarseLoads::add_up(const CoarseProblem& problem, std::span<const double> u, std::span<const double> r,
                         const TeamLoops& loops) {
  const int strips = problem.plan.strips();
  const auto rest = [&](int strip) {
    const auto& first = problem.plan.strip_bodies;
    std::fill(moves_.begin() + first[strip], moves_.begin() + first[strip + 1], NodeMoves{});
  };
  const auto first_of = [&](int part) { return strips * part / parts; };
  loops.each_of(parts, [&](int part) {
    const int begin = first_of(part), end = first_of(part + 1);
    if (begin < end) rest(begin);
    for (int k = begin; k < end; ++k) {
      add_contacts(problem, u, r, 2 * k, work_[part]);
      if (k + 1 == end) break;
      rest(k + 1);
      add_contacts(problem, u, r, 2 * k + 1, work_[part]);
      if (k > begin) add_bodies(problem, k, rows_[part]);
    }
  });
  for (int part = 0; part < parts; ++part)
    if (const int last = first_of(part + 1) - 1; last >= first_of(part))
      add_contacts(problem, u, r, 2 * last + 1, work_[part]);
  loops.each_of(parts, [&](int part) {
    const int begin = first_of(part), last = first_of(part + 1) - 1;
    if (last >= begin) add_bodies(problem, begin, rows_[part]);
    if (last > begin) add_bodies(problem, last, rows_[part]);
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

void CoarseLoads::scale(const CoarseProblem& problem, std::span<const double> u, std::vector<double>& r,
                        const TeamLoops& loops) {
  for (auto& work : work_) work.assign(grid_.nodes(), 0.0);
  for (auto& rows : rows_) rows.assign(static_cast<std::size_t>(entries_of_node) * grid_.nodes(), 0.0);
  add_up(problem, u, r, loops);
  const std::vector<double> field = solve();
  if (field.empty()) return;
  loops.each(problem.i.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      const double factor = factor_at(grid_, places_[rank_[problem.i[a]]].place, field);
      for (int c = 0; c < problem.dim; ++c) r[problem.dim * a + c] *= factor;
    }
  });
}

}  // namespace drumlin::particles
