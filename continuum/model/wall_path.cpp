#include "continuum/model/wall_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "continuum/model/plane_vector.hpp"

namespace drumlin::continuum {
namespace {

constexpr double same_place = 1e-6;  // d
constexpr double same_turn = 1e-6, about_turn = std::numbers::pi - 1e-3;
constexpr std::size_t most_pieces = 100;

bool meets(const PartLine& line, Vec2 point) {
  const double s = line.nearest(point);
  return line.distance(point) < same_place && s > -same_place && s < line.length + same_place;
}

// s of the point, as met beyond `from` in this sense; none if it lies before it.
std::optional<double> met_beyond(const PartLine& line, double from, double sense, Vec2 point) {
  if (!meets(line, point)) return {};
  double s = line.nearest(point);
  if (line.round() && sense * (s - from) < same_place) s += sense * line.length;
  if (sense * (s - from) < same_place) return {};
  return s;
}

// The whole way on a part from s on, up to the next place where another part begins or the way has to stop.
PathPiece piece_from(const Region& region, double time, int part, double s, double sense,
                     const std::vector<Vec2>& stops) {
  const PartLine line = line_of(region.parts[part], time);
  double end = sense > 0 ? line.length : 0;
  if (line.round()) end = s + sense * line.length;
  const auto shorten = [&](Vec2 point) {
    if (const auto met = met_beyond(line, s, sense, point); met && sense * (*met - end) < 0) end = *met;
  };
  for (const RegionPart& other : region.parts)
    if (const PartLine beside = line_of(other, time); is_there(other, time) && !beside.round())
      shorten(beside.at(0)), shorten(beside.at(beside.length));
  for (const Vec2 stop : stops) shorten(stop);
  return {part, line, s, end};
}

struct Departure {
  int part;
  double s, sense, turn;
};

// From a point at which one arrives in this direction.
std::optional<Departure> departure(const Region& region, double time, Vec2 point, Vec2 arrival, double hand) {
  std::optional<Departure> best;
  for (int k = 0; k < static_cast<int>(region.parts.size()); ++k) {
    const PartLine line = line_of(region.parts[k], time);
    if (!is_there(region.parts[k], time) || !meets(line, point)) continue;
    const double s = line.nearest(point);
    for (const double sense : {1.0, -1.0}) {
      if (line.round() ? sense != hand : sense > 0 ? s > line.length - same_place : s < same_place) continue;
      const Vec2 along = sense * line.tangent(s);
      const double turn = std::atan2(hand * cross(arrival, along), dot(arrival, along));
      if (std::abs(turn) > about_turn) continue;
      const bool opening = region.parts[k].kind == RegionPart::Kind::opening;
      if (!best || turn > best->turn + same_turn || (opening && turn > best->turn - same_turn))
        best = Departure{k, s, sense, turn};
    }
  }
  return best;
}

}  // namespace

Vec2 PathPiece::direction(double along) const { return sense() * line.tangent(from + sense() * along); }

std::vector<PathPiece> path_from(const Region& region, double time, int part, Vec2 point, double sense,
                                 double hand, const std::vector<Vec2>& stops) {
  std::vector<PathPiece> path;
  const PartLine line = line_of(region.parts[part], time);
  Vec2 arrival = sense * line.tangent(line.nearest(point));
  while (path.size() < most_pieces) {
    const auto next = departure(region, time, point, arrival, hand);
    if (!next) break;
    path.push_back(piece_from(region, time, next->part, next->s, next->sense, stops));
    const double end = path.back().length();
    point = path.back().at(end), arrival = path.back().direction(end);
    const auto here = [&](Vec2 stop) { return continuum::length(stop - point) < same_place; };
    if (is_open(region.parts[next->part], time) || std::ranges::any_of(stops, here)) break;
  }
  return path;
}

}  // namespace drumlin::continuum
