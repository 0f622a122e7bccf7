#include "particles/detection/grain_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::particles {
namespace {

constexpr std::size_t cells_per_piece = 256;
constexpr std::size_t pairs_per_share = 1024;
constexpr double rounding = 1 + 1e-12;  // two moved to compute a distance differ by less

/// Pairs weighed side by side: one loop over arrays, which a compiler makes of vectors.
template <std::size_t most>
class PairBatch {
 public:
  /// From b to a.
  void set(std::size_t k, const NearGrain& a, const NearGrain& b, const Period& period) {
    const Point whole{a.x - b.x, a.z - b.z}, d = period.nearest(whole);
    Point u{a.v_x - b.v_x, a.v_z - b.v_z};
    if (period.moves()) {
      const Point image = period.image_velocity({whole.x - d.x, whole.z - d.z});
      u.x -= image.x, u.z -= image.z;
    }
    const double sign = 2.0 * static_cast<int>(a.body < b.body) - 1;  // bodies stand in no order: no branch
    i_[k] = std::min(a.body, b.body), j_[k] = std::max(a.body, b.body);
    d_x_[k] = sign * d.x, d_z_[k] = sign * d.z;
    u_x_[k] = sign * u.x, u_z_[k] = sign * u.z;
    radii_[k] = a.radius + b.radius;
  }
  /// The pair of two bodies, the one of the lesser index first.
  void set(std::size_t k, const MovingDisc& i, const MovingDisc& j, double radii, const Period& period) {
    const Point whole{i.x - j.x, i.z - j.z}, d = period.open() ? whole : period.nearest(whole);
    Point u{i.v_x - j.v_x, i.v_z - j.v_z};
    if (period.moves()) {
      const Point image = period.image_velocity({whole.x - d.x, whole.z - d.z});
      u.x -= image.x, u.z -= image.z;
    }
    d_x_[k] = d.x, d_z_[k] = d.z;
    u_x_[k] = u.x, u_z_[k] = u.z;
    radii_[k] = radii;
  }
  void weigh(std::size_t count, double twice_step) {
    for (std::size_t k = 0; k < count; ++k) {
      const double apart = std::sqrt(d_x_[k] * d_x_[k] + d_z_[k] * d_z_[k]);
      const bool same_place = !(apart > 0);
      const double inverse = 1 / (apart + same_place);
      const double n_x = d_x_[k] * inverse, n_z = d_z_[k] * inverse + same_place;
      const double approach = -(n_x * u_x_[k] + n_z * u_z_[k]);
      d_x_[k] = n_x, d_z_[k] = n_z;
      gap_[k] = apart - radii_[k];
      reach_[k] = twice_step * ((approach + std::abs(approach)) / 2);
    }
  }
  NearPair pair(std::size_t k) const { return {i_[k], j_[k], gap_[k], d_x_[k], d_z_[k], reach_[k]}; }
  double gap(std::size_t k) const { return gap_[k]; }
  double n_x(std::size_t k) const { return d_x_[k]; }
  double n_z(std::size_t k) const { return d_z_[k]; }
  double reach(std::size_t k) const { return reach_[k]; }

 private:
  std::array<std::int32_t, most> i_, j_;
  std::array<double, most> d_x_, d_z_, u_x_, u_z_, radii_, gap_, reach_;  // d becomes the normal
};

}  // namespace

NearPair near_pair(const NearGrain& a, const NearGrain& b, const Period& period, double time_step) {
  PairBatch<1> one;
  one.set(0, a, b, period);
  one.weigh(1, 2 * time_step);
  return one.pair(0);
}

/// Collects pairs within a distance; without a branch that a processor could guess wrongly.
class GrainPairs::Collecting {
 public:
  Collecting(Piece& piece, double range, const Period& period)
      : piece_(piece), range_(range), period_(period) {}

  void meet(const NearGrain& a, std::span<const NearGrain> others) {
    piece_.distances += static_cast<std::int64_t>(others.size());
    const std::size_t most = piece_.count + others.size();
    if (piece_.near.size() < most) piece_.near.resize(std::max(most, most + most / 8));
    if (!period_.open_z())
      collect(a, others, [this](double dx, double dz) { return period_.nearest(Point{dx, dz}); });
    else if (period_.open())
      collect(a, others, [](double dx, double dz) { return Point{dx, dz}; });
    else
      collect(a, others, [this](double dx, double dz) { return Point{period_.nearest(dx), dz}; });
  }

 private:
  template <class Nearest>
  void collect(const NearGrain& a, std::span<const NearGrain> others, Nearest nearest) {
    const double x = a.x, z = a.z, reach = a.radius + range_;
    ListedPair* end = piece_.near.data() + piece_.count;
    for (const NearGrain& b : others) {
      const Point d = nearest(x - b.x, z - b.z);
      const double within = (reach + b.radius) * rounding;
      *end = {std::min(a.body, b.body), std::max(a.body, b.body)};
      end += d.x * d.x + d.z * d.z < within * within;
    }
    piece_.count = end - piece_.near.data();
  }

  Piece& piece_;
  const double range_;
  const Period period_;
};

void GrainPairs::use(WorkMemory* memory) {
  row_.use(memory), weights_.use(memory), closing_.use(memory), kept_.use(memory);
  discs_.use(memory);
}

std::size_t GrainPairs::bytes() const {
  std::size_t sum = list_.capacity() * sizeof(ListedPair) + shares_.capacity() * sizeof(Share);
  for (const Piece& piece : pieces_) sum += sizeof(Piece) + piece.near.capacity() * sizeof(ListedPair);
  for (const FarPart& part : far_parts_) sum += sizeof(FarPart) + part.pairs.capacity() * sizeof(NearPair);
  return sum + far_.capacity() * sizeof(NearPair) + tree_.bytes();
}

void GrainPairs::cut(const GrainGrids& grids) {
  used_ = 0;
  for (std::size_t level = 0; level < grids.grids().size(); ++level) {
    const std::size_t cells = grids.grids()[level].count();
    for (std::size_t first = 0; first < cells; first += cells_per_piece) {
      if (++used_ > pieces_.size()) pieces_.resize(used_);
      Piece& piece = pieces_[used_ - 1];
      piece.level = level, piece.first = first, piece.last = std::min(cells, first + cells_per_piece);
      piece.count = 0, piece.distances = 0;
    }
  }
}

template <class Work>
void GrainPairs::each_share(Work work) {
  loops_.each_of(static_cast<int>(shares_.size()), [&](int s) { work(shares_[s]); });
}

void GrainPairs::list(const GrainGrids& grids, const SearchedState& state, double range,
                      const PairRule& rule) {
  grids_ = &grids;
  range_ = range;
  planted_ = follows_ = false;
  cut(grids);
  loops_.each_of(static_cast<int>(used_), [&](int p) {
    Piece& piece = pieces_[p];
    Collecting collecting(piece, range, rule.period);
    grids.each_pair(
        piece.level, piece.first, piece.last,
        [&](const NearGrain& a, std::span<const NearGrain> others) { collecting.meet(a, others); });
  });
  put_in_order(state.bodies.count());
  distances_ = 0;
  for (std::size_t p = 0; p < used_; ++p) distances_ += pieces_[p].distances;
  cut_list();
  weigh_list(state, rule);
  drop_those_beyond();
  each_share([&](Share& share) { find_closing_listed(rule, share); });
}

/// Sorts the pairs of the pieces into the list.
void GrainPairs::put_in_order(std::size_t bodies) {
  row_.assign(bodies + 1, 0);
  const auto each = [&](auto visit) {
    for (std::size_t p = 0; p < used_; ++p)
      std::for_each(pieces_[p].near.begin(), pieces_[p].near.begin() + pieces_[p].count, visit);
  };
  each([&](const ListedPair& pair) { ++row_[pair.i + 1]; });
  for (std::size_t i = 1; i <= bodies; ++i) row_[i] += row_[i - 1];
  resize_closely(list_, row_[bodies]);
  each([&](const ListedPair& pair) { list_[row_[pair.i]++] = pair; });
  loops_.each(bodies, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto first = i == 0 ? 0 : row_[i - 1], last = row_[i];
      for (auto s = first + 1; s < last; ++s)  // rows are short
        for (auto t = s; t > first && list_[t].j < list_[t - 1].j; --t) std::swap(list_[t], list_[t - 1]);
    }
  });
}

void GrainPairs::cut_list() {
  shares_.resize(std::max<std::size_t>(1, (list_.size() + pairs_per_share - 1) / pairs_per_share));
  for (std::size_t s = 0; s < shares_.size(); ++s) {
    shares_[s].first = s * pairs_per_share;
    shares_[s].last = std::min(list_.size(), (s + 1) * pairs_per_share);
  }
}

void GrainPairs::collect_discs(const SearchedState& state) {
  const Bodies& bodies = state.bodies;
  const bool open = state.period.open();
  discs_.resize_uninitialized(bodies.count());
  loops_.each(bodies.count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Point place{bodies.x[b], bodies.z[b]}, first = open ? place : state.period.first(place);
      discs_[b] = {first.x, first.z, state.v_x[b], state.v_z[b]};
    }
  });
}

/// Weighs the pairs from the one numbered `done` on.
void GrainPairs::weigh_rest(std::span<const ListedPair> pairs, std::size_t done, const SearchedState& state,
                            double twice_step, PairWeight* weights) const {
  PairBatch<pairs_per_share> batch;
  const auto& radius = state.bodies.radius;
  const std::size_t count = pairs.size() - done;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [i, j] = pairs[done + k];
    batch.set(k, discs_[i], discs_[j], radius[i] + radius[j], state.period);
  }
  batch.weigh(count, twice_step);
  for (std::size_t k = 0; k < count; ++k)
    weights[done + k] = {batch.gap(k), batch.n_x(k), batch.n_z(k), batch.reach(k)};
}

void GrainPairs::weigh_list(const SearchedState& state, const PairRule& rule) {
  collect_discs(state);
  weights_.resize_uninitialized(list_.size()), closing_.resize_uninitialized(list_.size());
  each_share([&](Share& share) {
    const auto pairs = std::span(list_).subspan(share.first, share.last - share.first);
    PairWeight* const weights = weights_.data() + share.first;
    const auto& radius = state.bodies.radius;
    std::size_t done = 0;
    if (state.period.open())
      done = weigh_on_vectors(pairs, discs_.data(), radius.data(), 2 * rule.time_step, weights);
    weigh_rest(pairs, done, state, 2 * rule.time_step, weights);
    share.beyond = false;
    for (std::size_t k = 0; k < pairs.size(); ++k) share.beyond |= !(weights[k].gap < range_);
  });
}

/// The squares of distances, by which pairs are listed, round otherwise than distances.
void GrainPairs::drop_those_beyond() {
  if (std::none_of(shares_.begin(), shares_.end(), [](const Share& share) { return share.beyond; })) return;
  std::size_t end = 0;
  for (std::size_t p = 0; p < list_.size(); ++p) {
    if (!(weights_[p].gap < range_)) continue;
    list_[end] = list_[p], weights_[end] = weights_[p];
    ++end;
  }
  list_.resize(end);
  cut_list();
}

void GrainPairs::find_closing_listed(const PairRule& rule, Share& share) {
  std::int32_t* const begin = closing_.data() + share.first;
  std::int32_t* end = begin;
  for (std::size_t p = share.first; p < share.last; ++p) {
    const PairWeight& pair = weights_[p];
    *end = static_cast<std::int32_t>(p);
    end += static_cast<std::size_t>(pair.reach > 0) &
           static_cast<std::size_t>(pair.gap < rule.margin + pair.reach);
  }
  share.closing = end - begin;
}

void GrainPairs::weigh_again(const SearchedState& state, const PairRule& rule) {
  follows_ = false;
  distances_ = static_cast<std::int64_t>(list_.size());
  weigh_list(state, rule);
  each_share([&](Share& share) { find_closing_listed(rule, share); });
}

void GrainPairs::find_closing(const PairRule& rule, std::span<double> bounds) {
  far_.clear();
  far_distances_ = 0;
  const auto add = [&](std::int32_t i, std::int32_t j, double reach) {
    bounds[i] = std::max(bounds[i], reach);
    bounds[j] = std::max(bounds[j], reach);
  };
  find_far(rule, bounds, false);
  for (const NearPair& pair : far_) add(pair.i, pair.j, pair.reach);
  for (const Share& share : shares_)
    for (const std::int32_t p : std::span(closing_.data() + share.first, share.closing))
      add(list_[p].i, list_[p].j, weights_[p].reach);
}

void GrainPairs::find_by_bounds(const PairRule& rule, std::span<const double> bounds) {
  find_far(rule, bounds, true);
  distances_ += far_distances_;
}

void GrainPairs::find_far(const PairRule& rule, std::span<const double> bounds, bool by_bounds) {
  const double largest_bound = by_bounds ? *std::max_element(bounds.begin(), bounds.end()) : 0;
  const double moved = 2 * std::sqrt(2.0) * grids_->drift();
  if (rule.margin + 2 * rule.time_step * rule.speeds + largest_bound + moved <= range_)
    return;  // nothing is far
  if (!planted_)
    tree_.build(*grids_, rule.period, loops_);
  else if (!follows_)
    tree_.follow(loops_);
  planted_ = follows_ = true;
  if (by_bounds) tree_.set_bounds(bounds, loops_);
  const auto listed = [&](NearGrain a, NearGrain b) {
    a.x = a.sorted_x, a.z = a.sorted_z, b.x = b.sorted_x, b.z = b.sorted_z;
    return near_pair(a, b, rule.period, rule.time_step).gap < range_;
  };
  const auto measure = [&](const NearGrain& a, const NearGrain& b, const Point& shift, FarPart& part) {
    const Point d = rule.period.nearest(Point{a.x - b.x, a.z - b.z});
    if (!rule.period.open() && std::abs(a.x - b.x - shift.x - d.x) > rule.period.length / 2) return;
    if (!rule.period.open_z() && std::abs(a.z - b.z - shift.z - d.z) > rule.period.length_z / 2) return;
    ++part.distances;
    const NearPair pair = near_pair(a, b, rule.period, rule.time_step);
    const bool close = pair.gap < rule.margin + pair.reach;
    if (close == by_bounds) return;
    if (!close && pair.gap >= rule.margin + pair.reach + (bounds[pair.i] + bounds[pair.j]) / 2) return;
    if (!listed(a, b)) part.pairs.push_back(pair);
  };
  const FarSearch search{rule.time_step, rule.margin, range_, by_bounds};
  far_parts_.resize(std::max<std::size_t>(far_parts_.size(), tree_.cut(search)));
  for (FarPart& part : far_parts_) part.pairs.clear(), part.distances = 0;
  const auto meet = [&](int p, std::span<const NearGrain> a, std::span<const NearGrain> b, bool same,
                        const Image& image) {
    for (std::size_t k = 0; k < a.size(); ++k)
      for (std::size_t l = same ? k + 1 : 0; l < b.size(); ++l)
        measure(a[k], b[l], image.shift, far_parts_[p]);
  };
  tree_.far_pairs(search, loops_, meet);
  for (const FarPart& part : far_parts_) {
    far_.insert(far_.end(), part.pairs.begin(), part.pairs.end());
    far_distances_ += part.distances;
  }
}

namespace {

template <class Pair>
bool comes_before(const Candidate& extra, const Pair& pair) {
  return extra.i != pair.i ? extra.i < pair.i : extra.j < pair.j;
}

}  // namespace

/// The kept pairs of walls, and of grains that are not listed.
void GrainPairs::find_extras(const PairRule& rule, std::span<const double> bounds,
                             std::span<const WeighedPair> walls) {
  extras_.clear();
  for (const NearPair& far : far_) extras_.push_back({far.i, far.j, far.gap, far.n_x, far.n_z, 0, 0});
  for (const auto& [pair, reach] : walls)
    if (pair.gap < rule.margin + reach + bounds[pair.i] / 2) extras_.push_back(pair);
  std::sort(extras_.begin(), extras_.end(),
            [](const Candidate& a, const Candidate& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
}

void GrainPairs::keep(const PairRule& rule, std::span<const double> bounds,
                      std::span<const WeighedPair> walls, WorkArray<Candidate>& candidates) {
  find_extras(rule, bounds, walls);
  kept_.resize_uninitialized(list_.size());
  each_share([&](Share& share) {
    std::int32_t* const begin = kept_.data() + share.first;
    std::int32_t* end = begin;
    for (std::size_t p = share.first; p < share.last; ++p) {
      const PairWeight& pair = weights_[p];
      *end = static_cast<std::int32_t>(p);
      end += pair.gap < rule.margin + pair.reach + (bounds[list_[p].i] + bounds[list_[p].j]) / 2;
    }
    share.kept = end - begin;
  });
  std::size_t listed = 0;
  for (Share& share : shares_) {
    share.extras = 0;
    if (share.first > 0) {
      const auto before = [&](const Candidate& extra) { return comes_before(extra, list_[share.first]); };
      share.extras = std::partition_point(extras_.begin(), extras_.end(), before) - extras_.begin();
    }
    share.place = listed + share.extras;
    listed += share.kept;
  }
  const std::size_t all = listed + extras_.size();
  candidates.resize_uninitialized(all + all / 16);  // collided grains may add some
  candidates.resize_uninitialized(all);
  each_share([&](const Share& share) {
    const bool last = &share == &shares_.back();
    Candidate* to = candidates.data() + share.place;
    const Candidate* extra = extras_.data() + share.extras;
    const Candidate* const end = extras_.data() + (last ? extras_.size() : (&share + 1)->extras);
    for (const std::int32_t p : std::span(kept_.data() + share.first, share.kept)) {
      const ListedPair& pair = list_[p];
      const PairWeight& weight = weights_[p];
      while (extra < end && comes_before(*extra, pair)) *to++ = *extra++;
      *to++ = {pair.i, pair.j, weight.gap, weight.n_x, weight.n_z, 0, 0};
    }
    std::copy(extra, end, to);
  });
}

}  // namespace drumlin::particles
