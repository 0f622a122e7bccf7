#include "particles/stepping/wall_loads.hpp"

#include "particles/bodies/period.hpp"

namespace drumlin::particles {
namespace {

WallPlace place_of(const Walls& walls, std::size_t wall, std::span<const Shape> shapes,
                   std::span<const double> angles) {
  const Point middle = middle_of(shapes[first_shape(walls, static_cast<int>(wall))]);
  return {middle.x, middle.z, angles[wall]};
}

void add_contact(const WallContact& contact, const Bodies& bodies, const Period& period, WallLoad& load) {
  const double f_x = -(contact.n_x * contact.normal + contact.n_z * contact.tangential);
  const double f_z = -(contact.n_z * contact.normal - contact.n_x * contact.tangential);
  const double radius = bodies.radius[contact.i];
  const double x = period.nearest(bodies.x[contact.i] - radius * contact.n_x - load.last.x);
  const double z = bodies.z[contact.i] - radius * contact.n_z - load.last.z;
  load.impulse_x += f_x;
  load.impulse_z += f_z;
  load.moment += f_x * z - f_z * x - radius * contact.couple;
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
