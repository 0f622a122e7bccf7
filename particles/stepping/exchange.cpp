#include "particles/stepping/exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "particles/detection/contact_list.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/random.hpp"
#include "particles/scene/region.hpp"
#include "particles/scene/sizes.hpp"
#include "particles/stepping/events.hpp"

namespace drumlin::particles {
namespace {

constexpr double room_around = 0.01;  // of the radius
constexpr int tries = 20;             // per waiting grain and step

/// Contacts of kept grains, with their new indices.
void keep_contacts(std::span<const std::uint8_t> keep, int dim, ImpulseCache& memory) {
  std::vector<std::int32_t> place(keep.size(), -1);
  std::int32_t kept_bodies = 0;
  for (std::size_t b = 0; b < keep.size(); ++b)
    if (keep[b]) place[b] = kept_bodies++;
  std::size_t kept = 0;
  for (std::size_t c = 0; c < memory.i.size(); ++c) {
    const std::int32_t i = memory.i[c], j = memory.j[c];
    if (!keep[i] || (j >= 0 && !keep[j])) continue;
    memory.i[kept] = place[i];
    memory.j[kept] = j >= 0 ? place[j] : j;
    for (int k = 0; k < dim; ++k) memory.impulse[dim * kept + k] = memory.impulse[dim * c + k];
    ++kept;
  }
  memory.i.resize(kept), memory.j.resize(kept), memory.impulse.resize(dim * kept);
}

void take_away(const EventInput& in) {
  SimulationState& state = in.state;
  Bodies& bodies = state.bodies;
  const double mm = in.scales.length_m * 1e3;
  std::vector<std::uint8_t> keep;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const double x = in.setting.laws.period.first(bodies.x[b]) * mm, z = bodies.z[b] * mm;
    for (std::size_t o = 0; o < in.scene.outlets.size(); ++o) {
      if (!inside(in.scene.outlets[o].region, {x, z}, 0)) continue;
      if (keep.empty()) keep.assign(bodies.count(), 1);
      keep[b] = 0;
      OutletState& outlet = state.traffic->outlets[o];
      outlet.times.push_back(state.time());
      outlet.mass += 1 / bodies.inverse_mass[b];
      if (in.scene.outlets[o].returns_to)
        outlet.waiting.push_back(
            {bodies.radius[b], bodies.inverse_mass[b], bodies.material.empty() ? 0 : bodies.material[b]});
      break;
    }
  }
  if (keep.empty()) return;
  keep_contacts(keep, unknowns_of(in.setting.laws.contact_law), state.memory);
  keep_bodies(keep, bodies);
  for (auto& mark : state.marks) keep_entries(keep, mark.x), keep_entries(keep, mark.z);
  if (state.left) keep_entries(keep, state.left->has_left);
}

/// Where grains are put into a scene.
struct Opening {
  const Region& region;
  Point velocity;    ///< dimensionless
  std::string name;  ///< of its random numbers
};

Point velocity_of(const std::array<double, 2>& mm_s, const Scales& scales) {
  const double unit = 1e-3 / scales.velocity_m_s();
  return {mm_s[0] * unit, mm_s[1] * unit};
}

/// Puts grains into one region: it knows what stands near it.
class Pouring {
 public:
  Pouring(const EventInput& in, Opening opening)
      : in_(in),
        period_(in.setting.laws.period),
        shapes_(in.setting.walls.shapes_at(in.state.time_in_stage, in.state.driven)),
        opening_(std::move(opening)) {
    for (int axis : {0, 1}) {
      const auto [low, high] = extent_mm(opening_.region, axis);
      low_[axis] = low * 1e-3 / in.scales.length_m, high_[axis] = high * 1e-3 / in.scales.length_m;
    }
    const Bodies& bodies = in.state.bodies;
    for (std::size_t b = 0; b < bodies.count(); ++b) {
      const double reach = (1 + room_around) * bodies.radius[b];
      const double x = middle() + period_.nearest(bodies.x[b] - middle());
      if (bodies.z[b] > low_[1] - reach && bodies.z[b] < high_[1] + reach &&
          (!period_.open() || (x > low_[0] - reach && x < high_[0] + reach)))
        near_.push_back(b);
    }
  }

  /// Whether the grain found room; `number` of the grain at its source.
  bool put(const WaitingGrain& grain, std::int64_t number) {
    RandomStream places(in_.scene.seed, fmt::format("{}/{}/{}", opening_.name, number, in_.state.step));
    for (int t = 0; t < tries; ++t) {
      const Point place{places.uniform(low_[0], high_[0]), places.uniform(low_[1], high_[1])};
      if (!inside(place, grain.radius) || !free(place, grain.radius)) continue;
      add(grain, place);
      return true;
    }
    return false;
  }

 private:
  double middle() const { return (low_[0] + high_[0]) / 2; }

  bool inside(const Point& place, double radius) const {
    const double mm = in_.scales.length_m * 1e3;
    if (const auto* circle = std::get_if<CircleRegion>(&opening_.region))
      return std::hypot(place.x * mm - circle->center_mm[0], place.z * mm - circle->center_mm[1]) +
                 radius * mm <=
             circle->radius_mm;
    return place.x - radius >= low_[0] && place.x + radius <= high_[0] && place.z - radius >= low_[1] &&
           place.z + radius <= high_[1];
  }

  bool free(const Point& place, double radius) const {
    const Bodies& bodies = in_.state.bodies;
    const double apart = room_around * radius;
    for (const std::size_t b : near_)
      if (std::hypot(period_.nearest(bodies.x[b] - place.x), bodies.z[b] - place.z) <
          bodies.radius[b] + radius + apart)
        return false;
    for (const Shape& shape : shapes_) {
      if (is_open(shape)) continue;
      const double about = middle_of(shape).x;
      double n_x = 0, n_z = 0;
      Point point;
      if (gap_to_shape(shape, about + period_.nearest(place.x - about), place.z, radius, n_x, n_z, point) <
          apart)
        return false;
    }
    return true;
  }

  void add(const WaitingGrain& grain, const Point& place) {
    SimulationState& state = in_.state;
    Bodies& bodies = state.bodies;
    near_.push_back(bodies.count());
    add_body(bodies, place.x, place.z, grain.radius);
    bodies.v_x.back() = opening_.velocity.x, bodies.v_z.back() = opening_.velocity.z;
    bodies.inverse_mass.back() = grain.inverse_mass;
    if (in_.scene.effects.spin) bodies.spin.push_back(0);
    if (materials_matter(in_.scene)) bodies.material.push_back(static_cast<std::uint8_t>(grain.material));
    bodies.id.push_back(state.traffic->next_id++);
    if (state.left) state.left->has_left.push_back(0);
    for (auto& mark : state.marks) {  // it came at its velocity
      mark.x.push_back(place.x - (state.time() - mark.time) * opening_.velocity.x);
      mark.z.push_back(place.z - (state.time() - mark.time) * opening_.velocity.z);
    }
  }

  const EventInput& in_;
  Period period_;
  std::vector<Shape> shapes_;
  Opening opening_;
  double low_[2] = {0, 0}, high_[2] = {0, 0};  // d
  std::vector<std::size_t> near_;
};

void give_back(const EventInput& in) {
  for (std::size_t o = 0; o < in.scene.outlets.size(); ++o) {
    const Outlet& outlet = in.scene.outlets[o];
    OutletState& now = in.state.traffic->outlets[o];
    if (now.waiting.empty()) continue;
    Pouring pouring(in, {*outlet.returns_to, velocity_of(outlet.return_velocity_mm_s, in.scales),
                         "outlets/" + outlet.name});
    while (!now.waiting.empty() &&
           pouring.put(now.waiting.front(), now.taken() - static_cast<std::int64_t>(now.waiting.size())))
      now.waiting.pop_front();
  }
}

WaitingGrain drawn_grain(const EventInput& in, const Source& source, std::int64_t number) {
  RandomStream random(in.scene.seed, fmt::format("sources/{}/{}", source.name, number));
  const GeneratedGrains made{0, source.diameter_min_mm, source.diameter_max_mm, source.region, source.sizes};
  const double radius = drawn_diameter_mm(made, random) / 2 * 1e-3 / in.scales.length_m;
  const double density = source.density_kg_m3.value_or(in.scales.density_kg_m3) / in.scales.density_kg_m3;
  return {radius, 1 / (density * mass_of_disc(radius)),
          material_number(material_names(in.scene), source.material)};
}

void pour(const EventInput& in) {
  for (std::size_t s = 0; s < in.scene.sources.size(); ++s) {
    const Source& source = in.scene.sources[s];
    std::int64_t& poured = in.state.traffic->poured[s];
    std::int64_t left = waiting(source, poured, in.state.time() * in.scales.time_s);
    if (left == 0) continue;
    Pouring pouring(in,
                    {source.region, velocity_of(source.velocity_mm_s, in.scales), "sources/" + source.name});
    for (; left > 0 && pouring.put(drawn_grain(in, source, poured), poured); --left) ++poured;
  }
}

}  // namespace

Traffic first_traffic(const Scene& scene, Bodies& bodies) {
  bodies.id.resize(bodies.count());
  std::iota(bodies.id.begin(), bodies.id.end(), std::int64_t{0});
  return {static_cast<std::int64_t>(bodies.count()), std::vector<OutletState>(scene.outlets.size()),
          std::vector<std::int64_t>(scene.sources.size(), 0)};
}

void exchange_grains(const EventInput& in) {
  take_away(in);
  give_back(in);
  pour(in);
}

std::int64_t waiting(const Source& source, std::int64_t poured, double seconds) {
  // A grain that is due at a time of a step is due in spite of rounding.
  const double due = std::floor(source.grains_per_s * seconds * (1 + 1e-12) + 1e-9);
  const double most = source.count ? static_cast<double>(*source.count) : 1e15;
  return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::min(due, most)) - poured);
}

}  // namespace drumlin::particles
