#include "particles/stepping/wall_loads.hpp"

#include "particles/bodies/period.hpp"
#include "particles/bodies/vectors.hpp"

namespace drumlin::particles {
namespace {

WallPlace place_of(const Walls& walls, std::size_t wall, std::span<const Shape> shapes,
                   std::span<const double> angles) {
  const Point middle = middle_of(shapes[first_shape(walls, static_cast<int>(wall))]);
  return {middle.x, middle.z, angles[wall]};
}

void add_contact(const WallContact& contact, const Bodies& bodies, const Period& period, WallLoad& load) {
  const Point n{contact.n_x, contact.n_z}, p = -1 * with_parts(n, contact.normal, contact.tangential);
  const double radius = bodies.radius[contact.i];
  Point at = position(bodies, contact.i) - radius * n - Point{load.last.x, load.last.z};
  at.x = period.nearest(at.x);
  load.impulse_x += p.x, load.impulse_z += p.z;
  load.moment += across(at, p) - radius * contact.couple;
}

}  // namespace

void begin_interval(const Walls& walls, std::span<const Shape> shapes, std::span<const double> angles,
                    WallLoads& loads) {
  loads = {0, std::vector<WallLoad>(walls.names.size())};
  for (std::size_t w = 0; w < walls.names.size(); ++w)
    loads.walls[w].first = loads.walls[w].last = place_of(walls, w, shapes, angles);
}

void add_step(const Walls& walls, std::span<const Shape> shapes, std::span<const double> angles,
              std::span<const WallContact> contacts, const Bodies& bodies, double time_step,
              WallLoads& loads) {
  loads.time += time_step;
  for (std::size_t w = 0; w < loads.walls.size(); ++w) {
    if (!walls.open.empty() && walls.open[w]) continue;
    WallLoad& load = loads.walls[w];
    load.last = place_of(walls, w, shapes, angles);
    load.time += time_step;
    load.place.x += time_step * load.last.x;
    load.place.z += time_step * load.last.z;
    load.place.angle += time_step * load.last.angle;
  }
  const Period period{0, walls.period};
  for (const WallContact& contact : contacts)
    add_contact(contact, bodies, period, loads.walls[walls.wall_of_shape[contact.shape]]);
}

}  // namespace drumlin::particles
