#include "particles/contact/sweep_plan.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

namespace drumlin::particles {
namespace {

// A slice below this many contacts wastes vectors on the ends of its groups; strips come in fours, so that
// two and four threads share them evenly.
constexpr std::int32_t contacts_per_slice = 700;
constexpr std::int32_t strips_at_once = 4;
constexpr double most_slices = 4096;

struct Graph {
  std::vector<std::int32_t> start, neighbour;
};

bool moves(std::int32_t body, std::int32_t bodies) { return body >= 0 && body < bodies; }

Graph graph_of(std::int32_t bodies, std::span<const std::int32_t> i, std::span<const std::int32_t> j) {
  Graph graph;
  graph.start.assign(static_cast<std::size_t>(bodies) + 1, 0);
  for (std::size_t a = 0; a < i.size(); ++a)
    if (moves(j[a], bodies)) ++graph.start[i[a] + 1], ++graph.start[j[a] + 1];
  for (std::int32_t b = 0; b < bodies; ++b) graph.start[b + 1] += graph.start[b];
  graph.neighbour.resize(graph.start.back());
  auto place = graph.start;
  for (std::size_t a = 0; a < i.size(); ++a)
    if (moves(j[a], bodies)) {
      graph.neighbour[place[i[a]]++] = j[a];
      graph.neighbour[place[j[a]]++] = i[a];
    }
  return graph;
}

/// Distance of every body from the one where the search began; components follow one another.
class Levels {
 public:
  explicit Levels(const Graph& graph, std::int32_t bodies) : graph_(graph), bodies_(bodies) {}

  /// Bodies by level; `level` receives each one's.
  std::vector<std::int32_t> from(std::int32_t root, std::vector<std::int32_t>& level) const {
    level.assign(bodies_, -1);
    std::vector<std::int32_t> order;
    order.reserve(bodies_);
    visit(root, 0, order, level);
    for (std::int32_t b = 0; b < bodies_; ++b)
      if (level[b] < 0) visit(b, level[order.back()] + 1, order, level);
    return order;
  }

 private:
  void visit(std::int32_t root, std::int32_t first, std::vector<std::int32_t>& order,
             std::vector<std::int32_t>& level) const {
    std::size_t next = order.size();
    order.push_back(root);
    level[root] = first;
    for (; next < order.size(); ++next) {
      const std::int32_t b = order[next];
      for (std::int32_t k = graph_.start[b]; k < graph_.start[b + 1]; ++k) {
        const std::int32_t c = graph_.neighbour[k];
        if (level[c] >= 0) continue;
        level[c] = level[b] + 1;
        order.push_back(c);
      }
    }
  }

  const Graph& graph_;
  std::int32_t bodies_;
};

/// Merges levels into an even number of slices of about equal numbers of contacts; returns the slice of each
/// level.
std::vector<std::int32_t> slices_of_levels(std::span<const std::int32_t> contacts_of_level) {
  const auto levels = static_cast<std::int32_t>(contacts_of_level.size());
  std::int64_t contacts = 0;
  for (const std::int32_t count : contacts_of_level) contacts += count;
  std::int64_t strips = contacts / (2 * contacts_per_slice);
  if (strips > strips_at_once) strips -= strips % strips_at_once;
  strips = std::clamp<std::int64_t>(strips, 1, std::max(1, levels / 2));
  const std::int64_t slices = 2 * strips;
  std::vector<std::int32_t> slice(levels);
  std::int64_t seen = 0;
  for (std::int32_t l = 0; l < levels; ++l) {
    // By the middle of the level, so that a heavy level falls to the slice that holds most of it.
    const std::int64_t middle = 2 * seen + contacts_of_level[l];
    const std::int64_t share = contacts > 0 ? middle * slices / (2 * contacts) : 0;
    // No slice may be skipped: successive levels must lie in successive slices.
    const std::int64_t next = l == 0 ? 0 : slice[l - 1] + 1;
    slice[l] = static_cast<std::int32_t>(std::min({share, next, slices - 1}));
    seen += contacts_of_level[l];
  }
  return slice;
}

/// Slices from levels (or slices) of bodies, of which a pair never skips one.
std::vector<std::int32_t> merged(std::vector<std::int32_t> level, std::int32_t count,
                                 std::span<const std::int32_t> i, std::span<const std::int32_t> j) {
  const auto bodies = static_cast<std::int32_t>(level.size());
  std::vector<std::int32_t> contacts_of_level(count, 0);
  for (std::size_t a = 0; a < i.size(); ++a)
    ++contacts_of_level[moves(j[a], bodies) ? std::min(level[i[a]], level[j[a]]) : level[i[a]]];
  const auto slice_of_level = slices_of_levels(contacts_of_level);
  for (std::int32_t& l : level) l = slice_of_level[l];
  return level;
}

}  // namespace

std::vector<std::int32_t> body_slices(std::int32_t bodies, std::span<const std::int32_t> i,
                                      std::span<const std::int32_t> j) {
  if (bodies == 0) return {};
  const Graph graph = graph_of(bodies, i, j);
  const Levels levels(graph, bodies);
  std::vector<std::int32_t> level;
  // The body that is reached last is at the rim: levels from there are narrow.
  const std::int32_t rim = levels.from(0, level).back();
  const std::int32_t count = level[levels.from(rim, level).back()] + 1;
  return merged(std::move(level), count, i, j);
}

std::vector<std::int32_t> body_slices_along(std::span<const double> position, std::span<const std::int32_t> i,
                                            std::span<const std::int32_t> j) {
  if (position.empty()) return {};
  const auto bodies = static_cast<std::int32_t>(position.size());
  double low = position[0], high = low;
  for (const double x : position) low = std::min(low, x), high = std::max(high, x);
  double longest = 0;
  for (std::size_t a = 0; a < i.size(); ++a)
    if (moves(j[a], bodies)) longest = std::max(longest, std::abs(position[i[a]] - position[j[a]]));
  // A stray body far away must not make thousands of empty slices; rounding must not skip one.
  const double thickness = std::max(1.001 * longest, (high - low) / most_slices);
  std::vector<std::int32_t> slice(position.size(), 0);
  if (thickness > 0)
    for (std::size_t b = 0; b < position.size(); ++b)
      slice[b] = static_cast<std::int32_t>((position[b] - low) / thickness);
  const std::int32_t count = *std::max_element(slice.begin(), slice.end()) + 1;
  return merged(std::move(slice), count, i, j);
}

bool SweepPlanner::plan(std::span<const std::int32_t> slice_of_body, std::span<const std::int32_t> i,
                        std::span<const std::int32_t> j, SweepPlan& plan, std::vector<std::int32_t>& order) {
  const auto bodies = static_cast<std::int32_t>(slice_of_body.size());
  const std::size_t pairs = i.size();
  slice_of_contact_.resize_uninitialized(pairs);
  std::atomic<bool> suits = true;
  loops_.each(pairs, [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      std::int32_t slice = slice_of_body[i[a]];
      if (moves(j[a], bodies)) {
        const std::int32_t other = slice_of_body[j[a]];
        if (other > slice + 1 || slice > other + 1) suits = false;
        slice = std::min(slice, other);
      }
      slice_of_contact_[a] = slice;
    }
  });
  if (!suits) return false;
  const std::int32_t last = bodies > 0 ? *std::max_element(slice_of_body.begin(), slice_of_body.end()) : 0;
  const std::int32_t strips = last / 2 + 1;

  plan.strip_bodies.assign(strips + 1, 0);
  for (const std::int32_t slice : slice_of_body) ++plan.strip_bodies[slice / 2 + 1];
  for (std::int32_t k = 0; k < strips; ++k) plan.strip_bodies[k + 1] += plan.strip_bodies[k];
  plan.body_order.resize(bodies);
  start_.assign(plan.strip_bodies.begin(), plan.strip_bodies.end() - 1);
  for (std::int32_t b = 0; b < bodies; ++b) plan.body_order[start_[slice_of_body[b] / 2]++] = b;

  start_.assign(2 * static_cast<std::size_t>(strips) + 1, 0);
  for (const std::int32_t slice : slice_of_contact_) ++start_[slice + 1];
  for (std::int32_t s = 0; s < 2 * strips; ++s) start_[s + 1] += start_[s];
  by_slice_.resize_uninitialized(pairs);
  for (std::size_t a = 0; a < pairs; ++a)
    by_slice_[start_[slice_of_contact_[a]]++] = static_cast<std::int32_t>(a);

  resize_closely(order, pairs);
  colour_.resize_uninitialized(pairs);
  used_.resize_uninitialized(bodies);
  groups_.resize(2 * static_cast<std::size_t>(strips));
  // Slices of the same parity share no body, as in a sweep.
  for (const int parity : {0, 1}) loops_.each_of(strips, [&](int k) { colour(2 * k + parity, i, j, order); });
  plan.group_start.clear();
  plan.slice_start.clear();
  for (const auto& groups : groups_) {
    plan.slice_start.push_back(static_cast<std::int32_t>(plan.group_start.size()));
    plan.group_start.insert(plan.group_start.end(), groups.begin(), groups.end());
  }
  plan.slice_start.push_back(static_cast<std::int32_t>(plan.group_start.size()));
  plan.group_start.push_back(static_cast<std::int32_t>(order.size()));
  return true;
}

void SweepPlanner::colour(int slice, std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                          std::span<std::int32_t> order) {
  const std::int32_t begin = slice == 0 ? 0 : start_[slice - 1], end = start_[slice];
  const auto contacts = std::span<const std::int32_t>(by_slice_).subspan(begin, end - begin);
  groups_[slice].clear();
  std::vector<std::int32_t> left;  // of bodies with more contacts than a mask has bits: served in rounds
  std::int32_t first = begin;
  for (std::span<const std::int32_t> served = contacts; !served.empty();) {
    std::vector<std::int32_t> next_left;
    first = colour_round(served, first, i, j, groups_[slice], order, next_left);
    left = std::move(next_left);
    served = left;
  }
}

std::int32_t SweepPlanner::colour_round(std::span<const std::int32_t> served, std::int32_t first,
                                        std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                                        std::vector<std::int32_t>& groups, std::span<std::int32_t> order,
                                        std::vector<std::int32_t>& left) {
  constexpr int most = 64;
  const auto bodies = static_cast<std::int32_t>(used_.size());
  for (const std::int32_t a : served) {
    used_[i[a]] = 0;
    if (moves(j[a], bodies)) used_[j[a]] = 0;
  }
  std::array<std::int32_t, most + 1> start{};
  const auto colours = std::span<std::int8_t>(colour_).subspan(first, served.size());
  for (std::size_t k = 0; k < served.size(); ++k) {
    const std::int32_t a = served[k];
    const bool pair = moves(j[a], bodies);
    const std::uint64_t taken = used_[i[a]] | (pair ? used_[j[a]] : 0);
    const int colour = std::countr_one(taken);
    colours[k] = static_cast<std::int8_t>(colour);
    if (colour == most) {
      left.push_back(a);
      continue;
    }
    used_[i[a]] |= std::uint64_t{1} << colour;
    if (pair) used_[j[a]] |= std::uint64_t{1} << colour;
    ++start[colour + 1];
  }
  for (int c = 0; c < most && start[c + 1] > 0; ++c) {
    groups.push_back(first + start[c]);
    start[c + 1] += start[c];
  }
  for (std::size_t k = 0; k < served.size(); ++k)
    if (colours[k] < most) order[first + start[colours[k]]++] = served[k];
  return first + static_cast<std::int32_t>(served.size() - left.size());
}

SweepPlan sweep_plan(std::int32_t bodies, std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                     std::vector<std::int32_t>& order) {
  SweepPlan plan;
  SweepPlanner planner;
  if (bodies > 0) planner.plan(body_slices(bodies, i, j), i, j, plan, order);
  return plan;
}

}  // namespace drumlin::particles
