#pragma once
// One impact: a pair, and those that touch it and close at once, compressed and then expanded. Knows neither
// grains nor steps, only the bodies that it is given.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/vectors.hpp"

namespace drumlin::particles {

/// A grain, or a wall moved by a force, in a pass.
struct ImpactBody {
  std::int32_t body = 0;  ///< number in the step: grains, then walls moved by a force
  Point v;                ///< velocity; of a wall, along its direction alone
  double rim = 0;         ///< radius times spin
  double inverse_mass = 0;
  bool spins = false;  ///< turned by friction
  Point along;         ///< unit direction in which alone a wall moves; zero: a grain
  Point before;        ///< velocities at the beginning of the pass
  double before_rim = 0;
  PathShift shift;          ///< of a grain
  int passes = 0;           ///< in which it took part
  std::int32_t place = -1;  ///< in the pass in hand; -1: not there

  /// The shift of the path on which it goes on from a pass at a time.
  bool is_wall() const { return !is_zero(along); }
  PathShift shift_at(double time) const { return {shift + time * (before - v), time}; }
};

/// A pair in a pass. Normal and tangent as in Candidate.
struct ImpactContact {
  std::int32_t pair = 0;      ///< its number in the step
  std::int32_t i = 0, j = 0;  ///< positions of the bodies in the pass; j < 0: a wall that is not pushed
  Point n;
  Point wall;  ///< prescribed velocity of the wall, or of the image of j against j
  Point gain;  ///< relative velocity that forces have added since the beginning of the step
  double e = 0, mu = 0;
  double W_nn = 0, W_nt = 0, W_tt = 0;
  double normal = 0, tangential = 0;  ///< impulses of the pass
  double compression = 0;             ///< normal impulse of the compression
  double u_n = 0, u_t = 0;            ///< velocities before the pass
};

/// Work of impacts on grains; losses are negative.
struct ImpactWork {
  double normal = 0, tangential = 0;
  double walls = 0;
};

class ImpactPass {
 public:
  std::vector<ImpactBody> bodies;
  std::vector<ImpactContact> contacts;  ///< of the pass in hand

  double time = 0;  ///< of the pass in hand

  /// Forgets bodies and contacts; the next pass is at a time.
  void begin(double at) { bodies.clear(), contacts.clear(), time = at; }
  /// Adds a contact, with W and its velocities before the pass.
  void add(ImpactContact contact);
  /// Velocity of a contact as it stands: normal, tangential.
  Point velocity(const ImpactContact&) const;
  /// A few Gauss-Seidel sweeps, which show the bodies that the impacts move.
  void compress_roughly();
  /// Sweeps until no contact closes. Many contacts may keep part of their closing speeds: they meet again.
  void compress();
  /// Gives the normal impulses back times e; adds up the work of the pass.
  void expand(ImpactWork& work);

 private:
  void push(const ImpactContact&, double normal, double tangential);
  double sweep();
  double fastest() const;
  /// Share of the expansion that the energy allows: 1 where e is one number and the compression complete.
  bool is_exact() const;
  double share_of_expansion();
  void apply_friction(double share);
  void add_work(ImpactWork&) const;

  bool complete_ = false;         // the compression
  std::vector<double> friction_;  // impulses of the expansion
};

}  // namespace drumlin::particles
