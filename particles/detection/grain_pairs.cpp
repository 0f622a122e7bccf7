#include "particles/detection/grain_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::particles {
namespace {

constexpr std::size_t cells_per_piece = 256;
constexpr double rounding = 1 + 1e-12;  // two ways to compute a distance differ by less

/// Whether the grids show all pairs that may touch.
bool nothing_is_far(const PairRule& rule, double most_jolt) {
  return rule.margin + 2 * rule.time_step * rule.speeds + most_jolt <= rule.range;
}

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
    const double way = 2.0 * static_cast<int>(a.body < b.body) - 1;  // bodies stand in no order: no branch
    i_[k] = std::min(a.body, b.body), j_[k] = std::max(a.body, b.body);
    d_x_[k] = way * d.x, d_z_[k] = way * d.z;
    u_x_[k] = way * u.x, u_z_[k] = way * u.z;
    radii_[k] = a.radius + b.radius;
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

/// Collects pairs within a distance and weighs them by the hundred; without a branch that a processor could
/// guess wrongly.
class GrainPairs::Weighing {
 public:
  Weighing(Piece& piece, const PairRule& rule) : piece_(piece), rule_(rule), period_(rule.period) {}
  ~Weighing() { weigh(); }
  Weighing(const Weighing&) = delete;
  Weighing& operator=(const Weighing&) = delete;

  void meet(const NearGrain& a, std::span<const NearGrain> others) {
    piece_.looked_at += static_cast<std::int64_t>(others.size());
    while (!others.empty()) {
      if (count_ + others.size() > most) weigh();
      const auto some = others.first(std::min(others.size(), most));
      if (!period_.open_z())
        collect(a, some, [this](double dx, double dz) { return period_.nearest(Point{dx, dz}); });
      else if (period_.open())
        collect(a, some, [](double dx, double dz) { return Point{dx, dz}; });
      else
        collect(a, some, [this](double dx, double dz) { return Point{period_.nearest(dx), dz}; });
      others = others.subspan(some.size());
    }
  }

 private:
  static constexpr std::size_t most = 512;
  struct Found {
    const NearGrain *a, *b;
  };

  template <class Nearest>
  void collect(const NearGrain& a, std::span<const NearGrain> others, Nearest nearest) {
    const double x = a.x, z = a.z, reach = a.radius + rule_.range;
    std::size_t count = count_;
    for (const NearGrain& b : others) {
      const Point d = nearest(x - b.x, z - b.z);
      const double within = (reach + b.radius) * rounding;
      found_[count] = {&a, &b};
      count += d.x * d.x + d.z * d.z < within * within;
    }
    count_ = count;
  }

  void weigh() {
    for (std::size_t f = 0; f < count_; ++f) {
      const NearGrain &a = *found_[f].a, &b = *found_[f].b;
      batch_.set(f, a, b, period_);
    }
    batch_.weigh(count_, 2 * rule_.time_step);
    if (piece_.near.size() < piece_.count + count_) piece_.near.resize(piece_.count + count_);
    NearPair* const begin = piece_.near.data() + piece_.count;
    NearPair* end = begin;
    for (std::size_t f = 0; f < count_; ++f) {
      *end = batch_.pair(f);
      end += end->gap < rule_.range;
    }
    std::vector<Jolt>& jolts = piece_.jolts;
    std::size_t pushed = jolts.size();
    jolts.resize(pushed + (end - begin));
    for (const NearPair* pair = begin; pair < end; ++pair) {
      jolts[pushed] = {pair->i, pair->j, pair->reach};
      pushed += static_cast<std::size_t>(pair->reach > 0) &
                static_cast<std::size_t>(pair->gap < rule_.margin + pair->reach);
    }
    jolts.resize(pushed);
    piece_.count += end - begin;
    count_ = 0;
  }

  Piece& piece_;
  const PairRule rule_;
  const Period period_;
  std::array<Found, most> found_;
  PairBatch<most> batch_;
  std::size_t count_ = 0;
};

void GrainPairs::cut(const GrainGrids& grids) {
  used_ = 1;
  for (std::size_t level = 0; level < grids.grids().size(); ++level) {
    const std::size_t cells = grids.grids()[level].count();
    for (std::size_t first = 0; first < cells; first += cells_per_piece) {
      if (++used_ > pieces_.size()) pieces_.resize(used_);
      Piece& piece = pieces_[used_ - 1];
      piece.level = level, piece.first = first, piece.last = std::min(cells, first + cells_per_piece);
    }
  }
  for (std::size_t p = 0; p < used_; ++p)
    pieces_[p].count = 0, pieces_[p].jolts.clear(), pieces_[p].looked_at = 0;
}

void GrainPairs::add_jolts(const Piece& piece, std::span<double> jolts) const {
  for (const Jolt& jolt : piece.jolts) {
    jolts[jolt.i] = std::max(jolts[jolt.i], jolt.reach);
    jolts[jolt.j] = std::max(jolts[jolt.j], jolt.reach);
  }
}

void GrainPairs::look(const GrainGrids& grids, const PairRule& rule, std::span<double> jolts) {
  grids_ = &grids;
  planted_ = false;
  cut(grids);
  loops_.each_of(static_cast<int>(used_ - 1), [&](int p) {
    Piece& piece = pieces_[p + 1];
    Weighing weighing(piece, rule);
    grids.each_pair(piece.level, piece.first, piece.last,
                    [&](const NearGrain& a, std::span<const NearGrain> others) { weighing.meet(a, others); });
  });
  look_far(rule, jolts, false);
  looked_at_ = 0;
  for (std::size_t p = 0; p < used_; ++p) {
    add_jolts(pieces_[p], jolts);
    looked_at_ += pieces_[p].looked_at;
  }
}

void GrainPairs::look_after_jolts(const PairRule& rule, std::span<const double> jolts) {
  look_far(rule, jolts, true);
  looked_at_ += pieces_[0].looked_at;
}

void GrainPairs::look_far(const PairRule& rule, std::span<const double> jolts, bool after_jolts) {
  const double most_jolt = after_jolts ? *std::max_element(jolts.begin(), jolts.end()) : 0;
  if (nothing_is_far(rule, most_jolt)) return;
  if (!planted_) tree_.build(*grids_, rule.period, loops_);
  planted_ = true;
  if (after_jolts) tree_.set_jolts(jolts, loops_);
  Piece& piece = pieces_[0];
  piece.looked_at = 0;
  const auto look_at = [&](const NearGrain& a, const NearGrain& b, const Point& shift) {
    const Point d = rule.period.nearest(Point{a.x - b.x, a.z - b.z});
    if (!rule.period.open() && std::abs(a.x - b.x - shift.x - d.x) > rule.period.length / 2) return;
    if (!rule.period.open_z() && std::abs(a.z - b.z - shift.z - d.z) > rule.period.length_z / 2) return;
    ++piece.looked_at;
    const NearPair pair = near_pair(a, b, rule.period, rule.time_step);
    const bool close = pair.gap < rule.margin + pair.reach;
    if (pair.gap < rule.range || close == after_jolts) return;
    if (close)
      piece.jolts.push_back({pair.i, pair.j, pair.reach});
    else if (pair.gap >= rule.margin + pair.reach + (jolts[pair.i] + jolts[pair.j]) / 2)
      return;
    if (piece.count == piece.near.size()) piece.near.resize(2 * piece.count + 64);
    piece.near[piece.count++] = pair;
  };
  tree_.far_pairs(
      {rule.time_step, rule.margin, rule.range, after_jolts},
      [&](std::span<const NearGrain> a, std::span<const NearGrain> b, bool same, const Image& image) {
        for (std::size_t p = 0; p < a.size(); ++p)
          for (std::size_t q = same ? p + 1 : 0; q < b.size(); ++q) look_at(a[p], b[q], image.shift);
      });
}

/// Lists the pairs of each piece that may touch, and sorts them into slots by their first bodies.
void GrainPairs::place(const PairRule& rule, std::span<const double> jolts,
                       std::span<const WeighedPair> walls) {
  const auto kept = [&](double gap, double reach, double jolt) {
    return gap < rule.margin + reach + jolt / 2;
  };
  loops_.each_of(static_cast<int>(used_), [&](int p) {
    Piece& piece = pieces_[p];
    piece.kept.resize(piece.count);
    Slot* end = piece.kept.data();
    for (std::size_t k = 0; k < piece.count; ++k) {
      const NearPair& pair = piece.near[k];
      *end = {pair.i, pair.j, p, static_cast<std::int32_t>(k)};
      end += kept(pair.gap, pair.reach, jolts[pair.i] + jolts[pair.j]);
    }
    piece.kept.resize(end - piece.kept.data());
  });
  kept_walls_.clear();
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (const Candidate& pair = walls[w].pair; kept(pair.gap, walls[w].reach, jolts[pair.i]))
      kept_walls_.push_back({pair.i, pair.j, -1, static_cast<std::int32_t>(w)});
  row_.assign(jolts.size() + 1, 0);
  const auto each = [&](auto visit) {
    std::for_each(kept_walls_.begin(), kept_walls_.end(), visit);
    for (std::size_t p = 0; p < used_; ++p)
      std::for_each(pieces_[p].kept.begin(), pieces_[p].kept.end(), visit);
  };
  each([&](const Slot& slot) { ++row_[slot.i + 1]; });
  for (std::size_t i = 1; i < row_.size(); ++i) row_[i] += row_[i - 1];
  slots_.resize(row_.back());
  each([&](const Slot& slot) { slots_[row_[slot.i]++] = slot; });
}

void GrainPairs::keep(const PairRule& rule, std::span<const double> jolts, std::span<const WeighedPair> walls,
                      std::vector<Candidate>& candidates) {
  place(rule, jolts, walls);
  candidates.resize(slots_.size());
  loops_.each(jolts.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto first = i == 0 ? 0 : row_[i - 1], last = row_[i];
      for (auto s = first + 1; s < last; ++s)  // rows are short
        for (auto t = s; t > first && slots_[t].j < slots_[t - 1].j; --t) std::swap(slots_[t], slots_[t - 1]);
      for (auto s = first; s < last; ++s) {
        const Slot& slot = slots_[s];
        if (slot.piece < 0) {
          candidates[s] = walls[slot.place].pair;
          continue;
        }
        const NearPair& pair = pieces_[slot.piece].near[slot.place];
        candidates[s] = {pair.i, pair.j, pair.gap, pair.n_x, pair.n_z, 0, 0};
      }
    }
  });
}

}  // namespace drumlin::particles
