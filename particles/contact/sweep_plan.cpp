#include "particles/contact/sweep_plan.hpp"

#include <algorithm>
#include <bit>

namespace drumlin {
namespace {

// A strip below this many contacts wastes vectors on the ends of its groups; lanes come in fours, so that two
// and four threads share them evenly.
constexpr std::int32_t contacts_per_strip = 700;
constexpr std::int32_t lanes_at_once = 4;

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

/// Merges levels into an even number of strips of about equal numbers of contacts; returns the strip of each
/// level.
std::vector<std::int32_t> strips_of_levels(std::span<const std::int32_t> contacts_of_level) {
  const auto levels = static_cast<std::int32_t>(contacts_of_level.size());
  std::int64_t contacts = 0;
  for (const std::int32_t count : contacts_of_level) contacts += count;
  std::int64_t lanes = contacts / (2 * contacts_per_strip);
  if (lanes > lanes_at_once) lanes -= lanes % lanes_at_once;
  lanes = std::clamp<std::int64_t>(lanes, 1, std::max(1, levels / 2));
  const std::int64_t strips = 2 * lanes;
  std::vector<std::int32_t> strip(levels);
  std::int64_t seen = 0;
  for (std::int32_t l = 0; l < levels; ++l) {
    // By the middle of the level, so that a heavy level falls to the strip that holds most of it.
    const std::int64_t middle = 2 * seen + contacts_of_level[l];
    const std::int64_t share = contacts > 0 ? middle * strips / (2 * contacts) : 0;
    // No strip may be skipped: successive levels must lie in successive strips.
    const std::int64_t next = l == 0 ? 0 : strip[l - 1] + 1;
    strip[l] = static_cast<std::int32_t>(std::min({share, next, strips - 1}));
    seen += contacts_of_level[l];
  }
  return strip;
}

/// Greedy colours of the contacts of one strip. A body with more contacts than a mask has bits is served in
/// rounds, each with colours of its own.
class Colours {
 public:
  explicit Colours(std::int32_t bodies) : used_(bodies, 0), bodies_(bodies) {}

  /// Appends the contacts to `order`, colour by colour, and the beginning of each colour to `group_start`.
  void append(std::vector<std::int32_t> contacts, std::span<const std::int32_t> i,
              std::span<const std::int32_t> j, std::vector<std::int32_t>& order,
              std::vector<std::int32_t>& group_start) {
    constexpr int most = 64;
    std::vector<std::vector<std::int32_t>> of_colour;
    while (!contacts.empty()) {
      for (const std::int32_t a : contacts) {
        used_[i[a]] = 0;
        if (moves(j[a], bodies_)) used_[j[a]] = 0;
      }
      std::vector<std::int32_t> left;
      of_colour.assign(most, {});
      for (const std::int32_t a : contacts) {
        const bool pair = moves(j[a], bodies_);
        const std::uint64_t taken = used_[i[a]] | (pair ? used_[j[a]] : 0);
        const int colour = std::countr_one(taken);
        if (colour == most) {
          left.push_back(a);
          continue;
        }
        used_[i[a]] |= std::uint64_t{1} << colour;
        if (pair) used_[j[a]] |= std::uint64_t{1} << colour;
        of_colour[colour].push_back(a);
      }
      for (const auto& group : of_colour) {
        if (group.empty()) break;
        group_start.push_back(static_cast<std::int32_t>(order.size()));
        order.insert(order.end(), group.begin(), group.end());
      }
      contacts.swap(left);
    }
  }

 private:
  std::vector<std::uint64_t> used_;
  std::int32_t bodies_;
};

}  // namespace

SweepPlan sweep_plan(std::int32_t bodies, std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                     std::vector<std::int32_t>& order) {
  SweepPlan plan;
  order.clear();
  if (bodies == 0) return plan;
  const Graph graph = graph_of(bodies, i, j);
  const Levels levels(graph, bodies);
  std::vector<std::int32_t> level;
  // The body that is reached last is at the rim: levels from there are narrow.
  const std::int32_t rim = levels.from(0, level).back();
  plan.body_order = levels.from(rim, level);

  const std::int32_t count = level[plan.body_order.back()] + 1;
  const auto level_of = [&](std::size_t a) {
    return moves(j[a], bodies) ? std::min(level[i[a]], level[j[a]]) : level[i[a]];
  };
  std::vector<std::int32_t> contacts_of_level(count, 0);
  for (std::size_t a = 0; a < i.size(); ++a) ++contacts_of_level[level_of(a)];
  const auto strip_of_level = strips_of_levels(contacts_of_level);
  const std::int32_t strips = (strip_of_level.back() / 2 + 1) * 2;

  plan.lane_bodies.assign(strips / 2 + 1, 0);
  for (std::int32_t b = 0; b < bodies; ++b) ++plan.lane_bodies[strip_of_level[level[b]] / 2 + 1];
  for (std::int32_t k = 0; k < strips / 2; ++k) plan.lane_bodies[k + 1] += plan.lane_bodies[k];

  std::vector<std::vector<std::int32_t>> of_strip(strips);
  for (std::size_t a = 0; a < i.size(); ++a)
    of_strip[strip_of_level[level_of(a)]].push_back(static_cast<std::int32_t>(a));
  order.reserve(i.size());
  Colours colours(bodies);
  for (auto& contacts : of_strip) {
    plan.strip_start.push_back(static_cast<std::int32_t>(plan.group_start.size()));
    colours.append(std::move(contacts), i, j, order, plan.group_start);
  }
  plan.strip_start.push_back(static_cast<std::int32_t>(plan.group_start.size()));
  plan.group_start.push_back(static_cast<std::int32_t>(order.size()));
  return plan;
}

}  // namespace drumlin
