#include "particles/distributed/halo.hpp"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "particles/distributed/processor_time.hpp"

namespace drumlin::particles {

struct Halo::Requests {
  std::vector<MPI_Request> send, receive;
  std::vector<MPI_Status> status;
};

namespace {

std::size_t length_of(const std::vector<HaloRound::Leg>& legs) {
  std::size_t bodies = 0;
  for (const auto& leg : legs) bodies += leg.bodies.size();
  return bodies * Halo::numbers;
}

/// Legs under construction, by rank.
using Legs = std::map<std::int32_t, std::vector<std::int32_t>>;

std::vector<HaloRound::Leg> listed(Legs& legs) {
  std::vector<HaloRound::Leg> list;
  for (auto& [rank, bodies] : legs) list.push_back({rank, std::move(bodies)});
  return list;
}

}  // namespace

HaloPlan halo_plan(std::span<const SharedTouch> touches, std::int32_t rank) {
  std::array<Legs, 4> send, receive;
  std::vector<std::int32_t> users;
  for (std::size_t begin = 0, end = 0; begin < touches.size(); begin = end) {
    while (end < touches.size() && touches[end].body == touches[begin].body) ++end;
    users.clear();
    std::array<std::int32_t, 4> changes{-1, -1, -1, -1};  // rank whose contacts of a colour touch the grain
    for (const SharedTouch& touch : touches.subspan(begin, end - begin)) {
      users.push_back(touch.rank);
      if (touch.colour < 0) continue;
      if (changes[touch.colour] >= 0 && changes[touch.colour] != touch.rank)
        throw std::logic_error("two tiles of one colour share a grain");
      changes[touch.colour] = touch.rank;
    }
    std::sort(users.begin(), users.end());
    users.erase(std::unique(users.begin(), users.end()), users.end());
    if (!std::binary_search(users.begin(), users.end(), rank)) continue;
    for (int colour = 0; colour < 4; ++colour) {
      if (changes[colour] < 0) continue;
      if (changes[colour] != rank) {
        receive[colour][changes[colour]].push_back(touches[begin].body);
        continue;
      }
      for (const std::int32_t user : users)
        if (user != rank) send[colour][user].push_back(touches[begin].body);
    }
  }
  HaloPlan plan;
  for (int colour = 0; colour < 4; ++colour) plan[colour] = {listed(send[colour]), listed(receive[colour])};
  return plan;
}

Halo::Halo() : requests_(std::make_unique<Requests>()) {}
Halo::~Halo() = default;

void Halo::follow(const HaloPlan& plan) {
  plan_ = plan;
  for (int colour = 0; colour < 4; ++colour) {
    sent_[colour].resize(length_of(plan_[colour].send));
    received_[colour].resize(length_of(plan_[colour].receive));
  }
}

std::int64_t Halo::bytes_per_sweep() const {
  std::size_t length = 0;
  for (const auto& sent : sent_) length += sent.size();
  return static_cast<std::int64_t>(length * sizeof(double));
}

void Halo::start(int colour) {
  const HaloRound& round = plan_[colour];
  auto& [send, receive, status] = *requests_;
  send.resize(round.send.size()), receive.resize(round.receive.size());
  if (send.empty() && receive.empty()) return;
  const int tag = 100 + colour;
  std::size_t place = 0;
  for (std::size_t k = 0; k < receive.size(); ++k) {
    const auto length = round.receive[k].bodies.size() * numbers;
    MPI_Irecv(received_[colour].data() + place, static_cast<int>(length), MPI_DOUBLE, round.receive[k].rank,
              tag, MPI_COMM_WORLD, &receive[k]);
    place += length;
  }
  place = 0;
  for (std::size_t k = 0; k < send.size(); ++k) {
    const auto length = round.send[k].bodies.size() * numbers;
    MPI_Isend(sent_[colour].data() + place, static_cast<int>(length), MPI_DOUBLE, round.send[k].rank, tag,
              MPI_COMM_WORLD, &send[k]);
    place += length;
  }
  ++rounds_;
  bytes_ += static_cast<std::int64_t>(place * sizeof(double));
}

void Halo::finish(int colour) {
  if (plan_[colour].send.empty() && plan_[colour].receive.empty()) return;
  const WaitingTime waiting(waiting_seconds_);
  auto& [send, receive, status] = *requests_;
  status.resize(receive.size());
  MPI_Waitall(static_cast<int>(receive.size()), receive.data(), status.data());
  for (std::size_t k = 0; k < receive.size(); ++k) {
    int count = 0;
    MPI_Get_count(&status[k], MPI_DOUBLE, &count);
    if (static_cast<std::size_t>(count) != plan_[colour].receive[k].bodies.size() * numbers)
      throw std::logic_error("two ranks do not agree which grains they share");
  }
  MPI_Waitall(static_cast<int>(send.size()), send.data(), MPI_STATUSES_IGNORE);
}

}  // namespace drumlin::particles
