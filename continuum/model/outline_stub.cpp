#include "continuum/model/outline.hpp"
#include "continuum/model/mesh_motion.hpp"
#include "continuum/model/plane_vector.hpp"
#include <cmath>
#include <algorithm>
namespace drumlin::continuum {
Outline outline_of(const Region& region, double time) {
  Outline o;
  const auto n = region.fill.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = region.fill[i], b = region.fill[(i + 1) % n];
    // split at part ends
    std::vector<double> cuts{0, 1};
    for (const auto& p : region.parts) {
      if (time >= p.ends) continue;
      if (const auto* s = std::get_if<SegmentCurve>(&p.curve))
        for (const Vec2 e : {s->from, s->to}) {
          const double t = dot(e - a, b - a) / dot(b - a, b - a);
          if (t > 1e-9 && t < 1 - 1e-9 && length(a + t * (b - a) - e) < 1e-6 * length(b - a)) cuts.push_back(t);
        }
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      if (cuts[k + 1] - cuts[k] < 1e-9) continue;
      const Vec2 from = a + cuts[k] * (b - a), to = a + cuts[k + 1] * (b - a);
      int part = -1;
      for (std::size_t j = 0; j < region.parts.size(); ++j) {
        const auto& p = region.parts[j];
        if (time >= p.ends) continue;
        const auto c = curve_at(p, time);
        const double tol = 1e-6 * length(b - a);
        bool on = true;
        for (const double s : {0.1, 0.5, 0.9}) {
          const Vec2 x = from + s * (to - from);
          on &= length(projected(c, x) - x) < tol;
        }
        if (on) part = static_cast<int>(j);
      }
      o.points.push_back(from);
      o.part.push_back(part);
    }
  }
  return o;
}
Outline resampled(const Outline& o, const std::function<double(Vec2)>& size) {
  const auto n = o.points.size();
  // start at a corner: where part changes
  std::size_t s0 = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (o.part[i] != o.part[(i + n - 1) % n]) { s0 = i; break; }
  Outline r;
  for (std::size_t i = 0; i < n;) {
    const std::size_t a = (s0 + i) % n;
    const int part = o.part[a];
    std::size_t k = 1;
    while (i + k < n && o.part[(a + k) % n] == part) ++k;
    std::vector<Vec2> chain;
    for (std::size_t j = 0; j <= k; ++j) chain.push_back(o.points[(a + j) % n]);
    if (part >= 0) {
      const Vec2 from = chain.front(), to = chain.back();
      std::vector<double> s{0};
      const double L = length(to - from);
      while (s.back() < L) s.push_back(s.back() + size(from + (s.back() / L) * (to - from)));
      if (s.size() > 2 && s.back() - L > 0.5 * (s.back() - s[s.size() - 2])) s.pop_back();
      for (std::size_t j = 0; j + 1 < s.size(); ++j) r.points.push_back(from + (s[j] / s.back()) * (to - from)), r.part.push_back(part);
    } else {
      for (int pass = 0; pass < 12; ++pass) {
        std::vector<Vec2> g{chain[0]};
        bool any = false;
        for (std::size_t j = 1; j < chain.size(); ++j) {
          const double L = length(chain[j] - chain[j - 1]);
          if (L > 1.5 * size(chain[j])) {
            Vec2 mid = 0.5 * (chain[j] + chain[j - 1]);
            if (j >= 2 && j + 1 < chain.size()) {
              const Vec2 cub = (9. / 16) * (chain[j] + chain[j - 1]) - (1. / 16) * (chain[j + 1] + chain[j - 2]);
              if (length(cub - mid) < 0.02 * L) mid = cub;
            }
            g.push_back(mid); any = true;
          }
          g.push_back(chain[j]);
        }
        chain = g;
        if (!any) break;
      }
      for (std::size_t j = 1; j + 1 < chain.size();) {
        const double h = size(chain[j]);
        if (length(chain[j] - chain[j - 1]) < 0.5 * h || (j + 2 == chain.size() && length(chain[j] - chain[j + 1]) < 0.5 * h)) chain.erase(chain.begin() + j);
        else ++j;
      }
      for (std::size_t j = 0; j + 1 < chain.size(); ++j) r.points.push_back(chain[j]), r.part.push_back(-1);
    }
    i += k;
  }
  return r;
}
Outline with_area(const Outline& o, double target) {
  Outline r = o;
  const auto n = o.points.size();
  for (int it = 0; it < 3; ++it) {
    const double miss = target - area(r);
    double L = 0;
    for (std::size_t i = 0; i < n; ++i) if (r.part[i] < 0) L += length(r.points[(i + 1) % n] - r.points[i]);
    Outline g = r;
    for (std::size_t i = 0; i < n; ++i)
      if (r.part[i] < 0 && r.part[(i + n - 1) % n] < 0) {
        const Vec2 t = r.points[(i + 1) % n] - r.points[(i + n - 1) % n];
        g.points[i] = r.points[i] + (miss / L / length(t)) * Vec2{t.z, -t.x};
      }
    r = g;
  }
  return r;
}
Outline laid_down(const Outline& o, const Region& region, double, const std::function<double(Vec2)>& size) {
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
      Vec2 t = part_tangent(wall, r.points[i]);
      const auto i1 = ends ? (i + 1) % n : (i + n - 1) % n, i2 = ends ? (i + 2) % n : (i + n - 2) % n;
      const Vec2 in = ends ? r.points[b] - r.points[i] : r.points[(i + 1) % n] - r.points[i];
      if (dot(t, in) > 0) t = -1 * t;   // t points away from the wetted wall
      Vec2 nrm{-t.z, t.x};
      // material side normal: for ends, walking anticlockwise wall->free: material on left of direction t
      if (!ends) nrm = -1 * nrm;
      const Vec2 e1 = r.points[i1] - r.points[i], e2 = r.points[i2] - r.points[i];
      const double x1 = dot(e1, t), z1 = dot(e1, nrm), x2 = dot(e2, t), z2 = dot(e2, nrm);
      if ((x1 > 0 && z1 < tg * x1) || z1 < 0.02 * size(r.points[i1])) {
        double xt = x1;
        if (z2 > 0.1 * size(r.points[i1])) xt = (x1 * z2 - z1 * x2) / z2;
        if (!(xt > 0)) continue;
        r.points[i] = r.points[i] + xt * t;
        r.points.erase(r.points.begin() + i1);
        r.part.erase(r.part.begin() + i1);
        again = true;
      }
    }
  }
  return r;
}
}
