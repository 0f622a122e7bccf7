#pragma once
// What ranks tell each other between the colours of a sweep: the velocities of the grains that contacts of
// several ranks touch.
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace drumlin::particles {

/// Of one colour: grains that contacts of this rank may have changed and others use, and the reverse. Both
/// sides list the same grains in the order of their identities, so that no message names them.
struct HaloRound {
  struct Leg {
    std::int32_t rank = 0;
    std::vector<std::int32_t> bodies;
  };
  std::vector<Leg> send, receive;
};
using HaloPlan = std::array<HaloRound, 4>;

/// Who touches a grain that is not this rank's alone.
struct SharedTouch {
  std::int32_t body = 0, rank = 0;
  std::int32_t colour = 0;  ///< of the contact; -1: the owner of the grain, who wants to know
};
/// The plan of a rank that knows all touches of each grain that it uses. `touches` in the order of the
/// identities of the bodies, by which ranks agree on the order of what they send.
HaloPlan halo_plan(std::span<const SharedTouch> touches, std::int32_t rank);

/// Sends along a plan, three numbers per grain.
class Halo {
 public:
  static constexpr int numbers = 3;

  Halo();
  ~Halo();
  Halo(const Halo&) = delete;
  Halo& operator=(const Halo&) = delete;

  void follow(const HaloPlan& plan);
  const HaloPlan& plan() const { return plan_; }

  /// Sends what contacts of a colour have changed; `get(body)` gives an array of three numbers.
  template <class Get>
  void start(int colour, Get get) {
    auto& out = sent_[colour];
    std::size_t k = 0;
    for (const auto& leg : plan_[colour].send)
      for (const std::int32_t b : leg.bodies)
        for (const double number : get(b)) out[k++] = number;
    start(colour);
  }
  /// Waits for what others have changed; `set(body, numbers)` takes it.
  template <class Set>
  void finish(int colour, Set set) {
    finish(colour);
    const auto& in = received_[colour];
    std::size_t k = 0;
    for (const auto& leg : plan_[colour].receive)
      for (const std::int32_t b : leg.bodies) {
        set(b, std::array<double, numbers>{in[k], in[k + 1], in[k + 2]});
        k += numbers;
      }
  }

  /// Since the program began: rounds of messages in which this rank took part, and bytes that it sent.
  std::int64_t rounds() const { return rounds_; }
  std::int64_t bytes() const { return bytes_; }
  /// Processor time spent in waiting for messages.
  double waiting_seconds() const { return waiting_seconds_; }
  /// Sent within one sweep.
  std::int64_t bytes_per_sweep() const;

 private:
  struct Requests;
  void start(int colour);
  void finish(int colour);

  HaloPlan plan_;
  std::array<std::vector<double>, 4> sent_, received_;
  std::unique_ptr<Requests> requests_;
  std::int64_t rounds_ = 0, bytes_ = 0;
  double waiting_seconds_ = 0;
};

}  // namespace drumlin::particles
