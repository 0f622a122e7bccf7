#pragma once
// One proximal step of the reference solver by a semismooth Newton method.
#include <functional>
#include <optional>
#include <vector>

#include "particles/lab/reference_linear.hpp"

namespace drumlin::particles {

/// Asked before each factorisation; false ends the method there.
using MayFactorise = std::function<bool()>;

/// Solves the problem with a compliance 1/kappa (in units of W_aa) around given impulses: a piecewise linear
/// equation for the velocities, with one solution nearby even where the impulses are not unique. Its fixed
/// points are the exact solutions of the problem.
template <class Problem>
class ProximalNewton {
 public:
  explicit ProximalNewton(const Problem& problem);

  /// Impulses of the step from `centre`; nothing when Newton fails or may not go on.
  std::optional<std::vector<double>> step(const std::vector<double>& centre, double kappa,
                                          const MayFactorise& may_factorise);
  /// Factorisations of the last step.
  int factorisations() const { return factorisations_; }

 private:
  static constexpr int dim = Problem::dim;
  double evaluate(const std::vector<double>& r);
  void answer(int a);
  double search(std::vector<double>& r, const std::vector<double>& change, double& fault);

  const Problem& problem_;
  ResponseSystem<typename Problem::Delassus> system_;
  typename Problem::Delassus::State state_;
  std::vector<double> zero_, u_, answer_, difference_, image_;
  std::vector<ContactResponse> answers_;
  const std::vector<double>* centre_ = nullptr;
  double kappa_ = 0;
  int factorisations_ = 0;
};

}  // namespace drumlin::particles
