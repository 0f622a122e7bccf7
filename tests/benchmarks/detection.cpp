// What contact detection costs per grain, whatever the grains do and however many they are.
//
// usage: benchmark_detection RESULT.json
//
// Every scene is searched again and again on one thread, with its grains numbered as they stand and at
// random: the least processor time of a search counts.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/json/json_file.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/machine/own_costs.hpp"
#include "particles/detection/contact_list.hpp"
#include "tests/particles/many_grains.hpp"

namespace {

using namespace drumlin;
using namespace drumlin::particles;
using test::Grains;
using Json = nlohmann::ordered_json;
using Make = std::function<Grains(int, RandomStream&)>;

/// The same grains under other numbers.
Grains shuffled(const Grains& grains, RandomStream& random) {
  std::vector<std::size_t> order(grains.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = order.size(); k > 1; --k)
    std::swap(order[k - 1], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
  Grains other;
  for (const std::size_t b : order)
    other.add(grains.bodies.x[b], grains.bodies.z[b], grains.bodies.radius[b], grains.v_x[b], grains.v_z[b]);
  return other;
}

struct Price {
  double ns = 0, distances = 0, pairs = 0;  // per grain
};

Price price(const Grains& grains) {
  constexpr double shortest = 0.3, margin = 0.02;  // s of all repetitions; d
  constexpr int repetitions = 3;
  const DetectionInput input{{}, {}, test::grains_time_step, margin, {}};
  ContactDetection detection;
  const auto count = static_cast<double>(grains.count());
  Price best;
  double spent = 0;
  for (int k = 0; k <= repetitions || spent < shortest; ++k) {
    detection.forget();  // else a list of near pairs would be used again
    const double before = own_cpu_seconds();
    const auto& found = detection.find(grains.bodies, grains.v_x, grains.v_z, input);
    const double seconds = own_cpu_seconds() - before;
    if (k == 0) continue;  // memory is new
    spent += seconds;
    const double ns = 1e9 * seconds / count;
    if (k == 1 || ns < best.ns)
      best = {ns, static_cast<double>(detection.distances()) / count,
              static_cast<double>(found.size()) / count};
  }
  return best;
}

Json prices(const Make& make) {
  Json rows = Json::array();
  for (const int count : {1000, 10000, 100000, 1000000}) {
    RandomStream random(1, "benchmark");
    const Grains grains = make(count, random);
    const Price in_place = price(grains), at_random = price(shuffled(grains, random));
    rows.push_back({{"grains", grains.count()},
                    {"pairs_per_grain", in_place.pairs},
                    {"distances_per_grain", in_place.distances},
                    {"ns_per_grain", in_place.ns},
                    {"ns_per_grain_numbered_at_random", at_random.ns}});
  }
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: benchmark_detection RESULT.json\n");
    return static_cast<int>(ExitCode::wrong_input);
  }
  const std::vector<std::pair<std::string, Make>> scenes = {
      {"flowing", test::flowing},           {"falling together", test::all_fall},
      {"falling on others", test::falling}, {"with a stray grain", test::with_stray},
      {"scattered", test::scattered},       {"one to ten", test::unlike}};
  Json result{
      {"format", "drumlin-detection-cost-1"}, {"command", "benchmark_detection RESULT"}, {"reduced", false}};
  result["load_before"] = load_average();
  result["provenance"] = provenance();
  for (const auto& [name, make] : scenes) {
    result["scenes"][name] = prices(make);
    result["load_after"] = load_average();
    apps::write_json(argv[1], result);
    fmt::print(stderr, "{}\n{}\n", name, result["scenes"][name].dump(1));
  }
  return 0;
}
