#pragma once
// 99 % intervals of averages over time-correlated samples: contiguous batches, delete-one jackknife over
// them.
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace drumlin::particles {

/// Which of `batches` contiguous batches of almost equal length sample `index` of `count` belongs to.
std::size_t batch_of(std::size_t index, std::size_t count, std::size_t batches);

/// Half widths of 99 % intervals per standard error, for `batches` batches: Student's t for half as many,
/// since the correlation of neighbours is estimated from them too. At least two batches.
double interval_factor(std::size_t batches);

/// Half width of the 99 % interval from the values e_b of an estimate with one batch left out each, in order
/// of time: interval_factor(B) sqrt((B - 1)/B (sum e_b'^2 + 2 max(0, sum e_b' e_(b+1)'))), ' counted from the
/// mean. For a plain mean over equal batches this is the method of batch means with the correlation of
/// neighbouring batches added; unlike it, it stays right for ratios and fits. NaN with fewer than two values
/// or when one of them is not finite.
double jackknife_ci99(std::span<const double> leave_one_out);

/// Adds sums, a struct of nothing but doubles, number by number.
template <class Sums>
void add_times(double factor, const Sums& from, Sums& to) {
  using Numbers = std::array<double, sizeof(Sums) / sizeof(double)>;
  // What std::bit_cast is made of: not every C++ library has that.
  const Numbers more = __builtin_bit_cast(Numbers, from);
  Numbers numbers = __builtin_bit_cast(Numbers, to);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] += factor * more[i];
  to = __builtin_bit_cast(Sums, numbers);
}

/// Something of the whole run, and the same without one batch each; `without` is empty with fewer than two.
template <class Of>
struct LeaveOneOut {
  Of whole;
  std::vector<Of> without;
};

/// From the sums of each batch, of which there must be one.
template <class Sums>
LeaveOneOut<Sums> leave_one_out(const std::vector<Sums>& batches) {
  LeaveOneOut<Sums> result{batches.front(), {}};
  for (std::size_t b = 1; b < batches.size(); ++b) add_times(1, batches[b], result.whole);
  for (std::size_t b = 0; b < batches.size() && batches.size() > 1; ++b)
    add_times(-1, batches[b], result.without.emplace_back(result.whole));
  return result;
}

/// What a function makes of each, of one or of several that have the same batches.
template <class Function, class First, class... Of>
auto each_of(const Function& function, const LeaveOneOut<First>& first, const LeaveOneOut<Of>&... others) {
  LeaveOneOut<decltype(function(first.whole, others.whole...))> result{function(first.whole, others.whole...),
                                                                       {}};
  for (std::size_t b = 0; b < first.without.size(); ++b)
    result.without.push_back(function(first.without[b], others.without[b]...));
  return result;
}

/// Half width of a number that `value_of`, a function or a member, reads off each.
template <class Of, class Value>
double ci99_of(const LeaveOneOut<Of>& given, const Value& value_of) {
  std::vector<double> values;
  values.reserve(given.without.size());
  for (const Of& one : given.without) values.push_back(std::invoke(value_of, one));
  return jackknife_ci99(values);
}

/// Of some values of a series.
struct SeriesSum {
  double sum = 0, count = 0;
  double mean() const { return sum / count; }
};
/// Of the batches of a series in order of time, `batches` or as many as it has values.
std::vector<SeriesSum> batch_sums(std::span<const double> series, std::size_t batches);
/// Half width for the mean of a series, over `batches` batches of it; NaN with fewer than two values.
double mean_ci99(std::span<const double> series, std::size_t batches = 20);

}  // namespace drumlin::particles
