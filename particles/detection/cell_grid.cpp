#include "particles/detection/cell_grid.hpp"

#include <bit>

namespace drumlin::particles {

void CellGrid::sort(const SearchedState& state, std::span<const std::int32_t> members, double cell_size) {
  const Bodies& bodies = state.bodies;
  const std::size_t count = members.size();
  period_ = state.period;
  double left = bodies.x[members[0]], right = left, low = bodies.z[members[0]], high = low;
  for (const std::int32_t b : members) {
    left = std::min(left, bodies.x[b]), right = std::max(right, bodies.x[b]);
    low = std::min(low, bodies.z[b]), high = std::max(high, bodies.z[b]);
  }
  if (!period_.open_z()) low = period_.origin_z, high = low + period_.length_z;
  origin_x_ = period_.open() ? left : period_.origin;
  origin_z_ = low;
  const double width = period_.open() ? right - left : period_.length;
  cell_size = std::max(cell_size, std::max(width, high - low) / (1 << 30));  // so that positions are integers
  columns_ = period_.open() ? static_cast<int>(width / cell_size) + 1
                            : std::max(1, static_cast<int>(width / cell_size));
  const int rows = static_cast<int>((high - low) / cell_size) + 1;
  cell_x_ = period_.open() ? cell_size : period_.length / columns_;
  cell_z_ = cell_size;
  const int column_bits = std::bit_width(static_cast<unsigned>(columns_ - 1)),
            row_bits = std::bit_width(static_cast<unsigned>(rows - 1));
  places_.resize_uninitialized(count);
  for (std::size_t m = 0; m < count; ++m) {
    const std::int32_t b = members[m];
    const Point first = period_.first({bodies.x[b], bodies.z[b]});
    const int column = std::clamp(static_cast<int>((first.x - origin_x_) / cell_x_), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>((first.z - origin_z_) / cell_z_), 0, rows - 1);
    places_[m] = {static_cast<std::uint64_t>(row) << column_bits | static_cast<std::uint64_t>(column), b};
  }
  sort_places(row_bits + column_bits);
  resize_closely(grains_, count);
  drift_ = 0;
  cells_.clear();
  rows_.clear();
  const std::uint64_t column_mask = (std::uint64_t{1} << column_bits) - 1;
  for (std::size_t m = 0; m < count; ++m) {
    const auto [key, b] = places_[m];
    const Point first = period_.first({bodies.x[b], bodies.z[b]});
    grains_[m] = {first.x, first.z, bodies.radius[b], state.v_x[b], state.v_z[b], b, first.x, first.z};
    if (m > 0 && key == places_[m - 1].key) continue;
    const auto row = static_cast<std::int32_t>(key >> column_bits);
    if (rows_.empty() || rows_.back().row != row)
      rows_.push_back({row, static_cast<std::int32_t>(cells_.size())});
    cells_.push_back({row, static_cast<std::int32_t>(key & column_mask), static_cast<std::int32_t>(m)});
  }
  rows_.push_back({rows, static_cast<std::int32_t>(cells_.size())});
  cells_.push_back({rows, 0, static_cast<std::int32_t>(count)});
}

namespace {

/// What has become of some grains since they were sorted.
struct Followed {
  double farthest = 0;
  bool same = true;
  void add(const Followed& more) { farthest = std::max(farthest, more.farthest), same &= more.same; }
};

}  // namespace

bool CellGrid::follow(const SearchedState& state, const ParallelLoops& loops) {
  const auto all = loops.combined<Followed>(grains_.size(), [&](std::size_t begin, std::size_t end) {
    Followed some;
    for (NearGrain& g : std::span(grains_).subspan(begin, end - begin)) {
      some.same &= g.radius == state.bodies.radius[g.body];
      g.x = state.bodies.x[g.body], g.z = state.bodies.z[g.body];
      g.v_x = state.v_x[g.body], g.v_z = state.v_z[g.body];
      some.farthest = std::max({some.farthest, std::abs(g.x - g.sorted_x), std::abs(g.z - g.sorted_z)});
    }
    return some;
  });
  drift_ = all.farthest;
  return all.same;
}

/// By as many counting sorts as the keys have digits of at most 12 bits, the last digit first.
void CellGrid::sort_places(int bits) {
  constexpr int widest = 12;
  const int passes = (bits + widest - 1) / widest;
  if (passes == 0) return;
  const int width = (bits + passes - 1) / passes;
  std::vector<std::int32_t> start;
  sorted_.resize_uninitialized(places_.size());
  for (int pass = 0; pass < passes; ++pass) {
    const auto digit = [shift = pass * width, mask = (std::uint64_t{1} << width) - 1](std::uint64_t key) {
      return static_cast<std::size_t>(key >> shift & mask);
    };
    start.assign((std::size_t{1} << width) + 1, 0);
    for (const Place& place : places_) ++start[digit(place.key) + 1];
    for (std::size_t d = 1; d < start.size(); ++d) start[d] += start[d - 1];
    for (const Place& place : places_) sorted_[start[digit(place.key)]++] = place;
    std::swap(places_, sorted_);
  }
}

std::size_t CellGrid::row_at(std::int64_t row) const {
  const auto rows = static_cast<std::int64_t>(rows_.size()) - 1;
  const auto guess = std::clamp<std::int64_t>(row - rows_[0].row, 0, rows);  // not before the one sought
  if (guess == 0 || rows_[guess - 1].row < row) return guess;
  return std::lower_bound(rows_.begin(), rows_.begin() + guess, row,
                          [](const Row& r, std::int64_t sought) { return r.row < sought; }) -
         rows_.begin();
}

std::size_t CellGrid::cell_at(std::size_t r, std::int64_t column) const {
  const std::int64_t first = rows_[r].first, end = rows_[r + 1].first;
  const auto guess = first + std::clamp<std::int64_t>(column - cells_[first].column, 0, end - first);
  if (guess == first || cells_[guess - 1].column < column) return guess;
  return std::lower_bound(cells_.begin() + first, cells_.begin() + guess, column,
                          [](const Cell& c, std::int64_t sought) { return c.column < sought; }) -
         cells_.begin();
}

std::size_t CellGrid::row_of_cell(std::size_t cell) const {
  return std::upper_bound(rows_.begin(), rows_.end(), static_cast<std::int32_t>(cell),
                          [](std::int32_t sought, const Row& r) { return sought < r.first; }) -
         rows_.begin() - 1;
}

void GrainGrids::sort(const SearchedState& state, double range) {
  const Bodies& bodies = state.bodies;
  range_ = range;
  drift_ = 0;
  period_ = state.period;
  const auto [small, large] = std::minmax_element(bodies.radius.begin(), bodies.radius.end());
  const double largest = 2 * *large;
  const bool alike = 2 * *small > *large;
  for (auto& members : members_) members.clear();
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    // A grid holds grains of more than half the diameter of its largest; below the range, size no longer
    // matters.
    const double size = std::max(2 * bodies.radius[b], std::min(range, largest));
    const auto level = alike ? 0 : static_cast<std::size_t>(std::ilogb(largest / size));
    if (level >= members_.size()) members_.resize(level + 1);
    members_[level].push_back(static_cast<std::int32_t>(b));
  }
  used_ = 0;
  largest_.clear();
  for (std::size_t level = 0; level < members_.size(); ++level) {
    if (members_[level].empty()) continue;
    if (used_ == grids_.size()) grids_.emplace_back().use(memory_);
    largest_.push_back(largest / std::exp2(level));
    grids_[used_++].sort(state, members_[level], largest_.back() + range);
  }
  count_ = bodies.count();
}

void GrainGrids::use(WorkMemory* memory) {
  memory_ = memory;
  for (CellGrid& grid : grids_) grid.use(memory);
}

std::size_t GrainGrids::bytes() const {
  std::size_t sum = 0;
  for (const CellGrid& grid : grids_) sum += grid.bytes();
  for (const auto& members : members_) sum += members.capacity() * sizeof(std::int32_t);
  return sum;
}

bool GrainGrids::follow(const SearchedState& state, double farthest, const ParallelLoops& loops) {
  if (!period_.open() || !state.period.open() || count_ != state.bodies.count()) return false;
  drift_ = 0;
  for (CellGrid& grid : std::span(grids_).first(used_)) {
    if (!grid.follow(state, loops)) return false;
    drift_ = std::max(drift_, grid.drift());
  }
  return drift_ <= farthest;
}

}  // namespace drumlin::particles
