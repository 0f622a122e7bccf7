#include "continuum/model/outline_stub.hpp"

#include <algorithm>
#include <cmath>

#include "continuum/model/outline.hpp"
#include "continuum/model/part_line.hpp"
#include "continuum/model/plane_vector.hpp"
namespace drumlin::continuum {
Outline laid_down(const Outline& o, const Region& region, double time, const SizeField& size) {
  Outline r = o;
  const double tg = 1;  // 45 deg
  for (bool again = true; again;) {
    again = false;
    const auto n = r.points.size();
    for (std::size_t i = 0; i < n && !again; ++i) {
      const auto b = (i + n - 1) % n;
      const bool ends = r.part[b] >= 0 && r.part[i] < 0, begins = r.part[b] < 0 && r.part[i] >= 0;
      if (!ends && !begins) continue;
      const auto& wall = region.parts[ends ? r.part[b] : r.part[i]];
      if (wall.kind == RegionPart::Kind::opening) continue;
      const PartLine line = line_of(wall, time);
      Vec2 t = line.tangent(line.nearest(r.points[i]));
      const auto i1 = ends ? (i + 1) % n : (i + n - 1) % n, i2 = ends ? (i + 2) % n : (i + n - 2) % n;
      const Vec2 in = ends ? r.points[b] - r.points[i] : r.points[(i + 1) % n] - r.points[i];
      if (dot(t, in) > 0) t = -1 * t;
      Vec2 nrm{-t.z, t.x};
      if (!ends) nrm = -1 * nrm;
      const Vec2 e1 = r.points[i1] - r.points[i], e2 = r.points[i2] - r.points[i];
      const double x1 = dot(e1, t), z1 = dot(e1, nrm), x2 = dot(e2, t), z2 = dot(e2, nrm);
      if ((x1 > 0 && z1 < tg * x1) || z1 < 0.02 * size(r.points[i1])) {
        double xt = x1;
        if (z2 > 0.1 * size(r.points[i1])) xt = (x1 * z2 - z1 * x2) / z2;
        if (!(xt > 0)) continue;
        r.points[i] = r.points[i] + xt * t;
        if (line.round()) r.points[i] = line.at(line.nearest(r.points[i]));
        r.points.erase(r.points.begin() + i1);
        r.part.erase(r.part.begin() + i1);
        again = true;
      }
    }
  }
  return r;
}
}  // namespace drumlin::continuum
