#include "particles/measurement/history/surface_history.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "coupling/core/statistics/straight_line.hpp"
#include "particles/measurement/frame/flow_frame.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = SurfaceState::none;
constexpr double widest = 20;             // d to each side of the middle of a drum: as theta_deg of measure
constexpr std::size_t least_count = 6;    // columns of a line
constexpr double least_height = 5;        // d, of a flank
constexpr double off = 2;                 // d from its line a top is no part of the surface
constexpr double toe = 0.2, crest = 0.8;  // shares of its height between which a flank is measured

struct Place {
  double x, z;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Slope and height at x = 0 of a line through tops.
struct Line {
  double slope, height;
};

/// The least squares line through the tops that lie within `off` of the line of median slope (Theil and Sen),
/// which a few grains out of line do not move.
std::optional<Line> line_through(const std::vector<Place>& places) {
  if (places.size() < least_count) return std::nullopt;
  std::vector<double> slopes, heights;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i + 1; j < places.size(); ++j)
      slopes.push_back((places[j].z - places[i].z) / (places[j].x - places[i].x));
  const double slope = median(std::move(slopes));
  for (const Place& place : places) heights.push_back(place.z - slope * place.x);
  const double height = median(std::move(heights));
  std::vector<double> x, z;
  for (const Place& place : places)
    if (std::abs(place.z - slope * place.x - height) <= off) x.push_back(place.x), z.push_back(place.z);
  const auto line = x.size() < least_count ? std::nullopt : statistics::fit_line(x, z);
  return line ? std::optional(Line{line->slope, line->intercept}) : std::nullopt;
}

std::vector<bool> resting_grains(const Snapshot& snapshot) {
  std::vector<bool> resting(snapshot.x.size(), !snapshot.contacts_known);
  for (const SnapshotContact& contact : snapshot.contacts)
    for (const std::int32_t grain : {contact.i, contact.j})
      if (grain >= 0) resting[static_cast<std::size_t>(grain)] = true;
  return resting;
}

/// Highest point of the discs in each column of 1 d, columns at whole multiples of 1 d in the frame.
std::vector<Place> tops(const Snapshot& snapshot, const std::vector<bool>& resting, const FlowFrame& frame) {
  std::map<double, double> highest;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const double r = snapshot.radius[i];
    const auto [x, z] = frame.place(snapshot.x[i], snapshot.z[i]);
    if (!resting[i] || !std::isfinite(x + z)) continue;
    for (double column = std::floor(x - r); column <= std::floor(x + r); ++column) {
      const double away = std::clamp(x, column, column + 1) - x;
      const double top = z + std::sqrt(std::max(0.0, r * r - away * away));
      const auto [place, fresh] = highest.try_emplace(column, top);
      if (!fresh) place->second = std::max(place->second, top);
    }
  }
  std::vector<Place> places;
  for (const auto& [column, top] : highest) places.push_back({column + 0.5, top});
  return places;
}

FlowFrame turned(const Snapshot& s, double theta) {
  return frame_at_slope(s.container_x, s.container_z, s.gravity_x, s.gravity_z, theta);
}

/// Twice from the angle of the centre of mass: the range, a quarter of the chord to each side, is that of the
/// surface.
double drum_angle(const Snapshot& snapshot, const std::vector<bool>& resting, double first_guess) {
  const double radius = snapshot.container_radius;
  double angle = first_guess, half_width = std::min(widest, radius / 2);
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<Place> places = tops(snapshot, resting, turned(snapshot, angle));
    std::erase_if(places, [&](const Place& place) { return std::abs(place.x) > half_width; });
    const auto line = line_through(places);
    if (!line) return none;
    const double depth = line->height * std::cos(std::atan(line->slope));
    half_width = std::min(widest, std::sqrt(std::max(0.0, radius * radius - depth * depth)) / 2);
    angle -= std::atan(line->slope);
  }
  return angle;
}

/// The angle at which tops fall from the first of them on; none without a heap.
double flank_angle(const std::vector<Place>& from_top) {
  const auto higher = [](const Place& a, const Place& b) { return a.z < b.z; };
  if (from_top.size() < least_count) return none;
  const double top = from_top.front().z, foot = std::min_element(from_top.begin(), from_top.end(), higher)->z;
  if (!(top - foot >= least_height)) return none;
  std::vector<Place> flank = from_top;
  std::erase_if(flank, [&](const Place& place) {
    const double share = (place.z - foot) / (top - foot);
    return share < toe || share > crest;
  });
  const auto line = line_through(flank);
  return line ? std::atan(std::abs(line->slope)) : none;
}

void find_flanks(const std::vector<Place>& places, SurfaceState& state) {
  const auto top = std::max_element(places.begin(), places.end(),
                                    [](const Place& a, const Place& b) { return a.z < b.z; });
  state.left = flank_angle({std::make_reverse_iterator(top + 1), places.rend()});
  state.right = flank_angle({top, places.end()});
  state.repose = std::isnan(state.left)    ? state.right
                 : std::isnan(state.right) ? state.left
                                           : (state.left + state.right) / 2;
}

}  // namespace

SurfaceState surface_state(const Snapshot& snapshot) {
  SurfaceState state;
  const bool weighs = std::hypot(snapshot.gravity_x, snapshot.gravity_z) > 0;
  if (!weighs || snapshot.period_x > 0 || snapshot.x.empty()) return state;
  const std::vector<bool> resting = resting_grains(snapshot);
  const FlowFrame upright = turned(snapshot, 0);
  if (snapshot.container_radius > 0) {
    state.mass_angle = centre_of_mass_angle(snapshot, upright);
    state.angle = drum_angle(snapshot, resting, state.mass_angle);
    return state;
  }
  const std::vector<Place> places = tops(snapshot, resting, upright);
  if (const auto line = line_through(places)) state.angle = -std::atan(line->slope);
  if (!places.empty()) find_flanks(places, state);
  return state;
}

}  // namespace drumlin::particles
