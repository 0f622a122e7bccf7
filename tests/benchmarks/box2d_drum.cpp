// The drum of a scene in Box2D 2.4: the same grains, stages and time steps, its own contact solver. Wall and
// processor seconds of b2World::Step alone, and the overlap that it leaves.
//
// usage: benchmark_box2d SCENE.toml RESULT.json [--from SNAPSHOT.h5 --seconds S [--skip S]]
//
// Without --from the whole scene is run. With it the flow starts from a snapshot of `drumlin run` on the same
// scene, in its last stage, for S simulated seconds of which the first --skip are not counted; the cost of
// the whole is extrapolated from there, and the result says so.
#include <box2d/box2d.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>

#include "apps/support/json_file.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/machine_load.hpp"
#include "coupling/documents/number_text.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/scene/placement.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/simulation.hpp"

namespace {

using namespace drumlin;
using namespace drumlin::particles;
using Json = nlohmann::ordered_json;

// Box2D's tolerances are made for bodies of 0.1 to 10 of its units: 1000 of them to the metre.
constexpr double units_per_metre = 1000;
constexpr int velocity_iterations = 20, position_iterations = 10;
constexpr int drum_edges = 360;   // they leave the circle by R (1 - cos(pi/360)): 0.26 % of a grain at 450 mm
constexpr int sample_every = 10;  // steps between two looks at the overlaps

struct Grain {
  double x, z, v_x, v_z, spin, radius;  // SI, laboratory frame, spin clockwise
};

std::vector<Grain> grains_at_start(const Scene& scene, const Scales& scales,
                                   const std::optional<Snapshot>& from) {
  const double length = scales.length_m, velocity = scales.velocity_m_s();
  std::vector<Grain> grains;
  if (from) {
    for (std::size_t i = 0; i < from->x.size(); ++i)
      grains.push_back({from->x[i] * length, from->z[i] * length, from->v_x[i] * velocity,
                        from->v_z[i] * velocity, from->spin.empty() ? 0 : from->spin[i] / scales.time_s,
                        from->radius[i] * length});
    return grains;
  }
  const Bodies bodies = place_grains(scene, scales);
  for (std::size_t i = 0; i < bodies.count(); ++i)
    grains.push_back({bodies.x[i] * length, bodies.z[i] * length, 0, 0, 0, bodies.radius[i] * length});
  return grains;
}

class Box2dDrum {
 public:
  Box2dDrum(const Scene& scene, const Scales& scales, const std::vector<Grain>& grains)
      : diameter_(scales.length_m * units_per_metre), world_(gravity_of(scene)) {
    if (scene.walls.size() != 1 || !std::holds_alternative<ContainerShape>(scene.walls[0].shape) ||
        !scene.effects.friction || !scene.effects.restitution || !scene.effects.spin)
      throw InputError("Box2D: the scene is no smooth drum with friction, restitution and spin");
    world_.SetAllowSleeping(false);
    // Grains move by less than themselves in a step: without continuous collision Box2D is faster.
    world_.SetContinuousPhysics(false);
    // Below 2 g h an approach is that of a lasting contact, as in Drumlin.
    threshold_ = static_cast<float>(2 * scene.effects.gravity->acceleration_m_s2 * units_per_metre *
                                    scene.stages.back().time_step_s);
    add_drum(scene);
    for (const Grain& grain : grains) add_grain(scene, grain);
  }

  void turn(double spin_rad_s) { drum_->SetAngularVelocity(static_cast<float>(-spin_rad_s)); }
  void step(double seconds) {
    world_.Step(static_cast<float>(seconds), velocity_iterations, position_iterations);
  }

  /// Adds the overlaps of the contacts that carry an impulse, in mean diameters.
  void sample_overlaps() {
    for (b2Contact* contact = world_.GetContactList(); contact != nullptr; contact = contact->GetNext()) {
      const b2Manifold& manifold = *contact->GetManifold();
      if (!contact->IsTouching() || manifold.pointCount == 0 || manifold.points[0].normalImpulse <= 0)
        continue;
      b2WorldManifold places;
      contact->GetWorldManifold(&places);
      const double overlap = std::max(0.0, -static_cast<double>(places.separations[0])) / diameter_;
      overlap_sum_ += overlap, overlap_max_ = std::max(overlap_max_, overlap), ++contacts_;
    }
    ++samples_;
    double x = 0, z = 0;
    for (const b2Body* body = world_.GetBodyList(); body != nullptr; body = body->GetNext())
      if (body != drum_)
        x += body->GetMass() * body->GetPosition().x, z += body->GetMass() * body->GetPosition().y;
    slope_sum_ += std::atan2(-x, -z) * 180 / std::numbers::pi;
  }

  Json accuracy() const {
    return {{"contacts_mean", contacts_ / samples_},
            {"overlap_mean", overlap_sum_ / contacts_},
            {"overlap_max", overlap_max_},
            {"theta_com_deg", slope_sum_ / samples_}};
  }

 private:
  static b2Vec2 gravity_of(const Scene& scene) {
    if (!scene.effects.gravity) throw InputError("Box2D: the scene has no gravity");
    const double angle = scene.effects.gravity->direction_deg * std::numbers::pi / 180;
    const double g = scene.effects.gravity->acceleration_m_s2 * units_per_metre;
    return {static_cast<float>(g * std::cos(angle)), static_cast<float>(g * std::sin(angle))};
  }

  void add_drum(const Scene& scene) {
    const auto& container = std::get<ContainerShape>(scene.walls[0].shape);
    const double radius = container.radius_mm * 1e-3 * units_per_metre;
    std::vector<b2Vec2> corners;
    for (int k = 0; k < drum_edges; ++k) {  // clockwise: the solid side is outside
      const double angle = -2 * std::numbers::pi * k / drum_edges;
      corners.emplace_back(static_cast<float>(radius * std::cos(angle)),
                           static_cast<float>(radius * std::sin(angle)));
    }
    b2ChainShape shape;
    shape.CreateLoop(corners.data(), drum_edges);
    b2BodyDef body;
    body.type = b2_kinematicBody;
    drum_ = world_.CreateBody(&body);
    const Friction& friction = *scene.effects.friction;
    b2FixtureDef fixture;
    fixture.shape = &shape;
    // Box2D takes the geometric mean of two bodies for a contact.
    fixture.friction = static_cast<float>(friction.grain_wall * friction.grain_wall / friction.grain_grain);
    fixture.restitution = static_cast<float>(scene.effects.restitution->grain_wall);
    fixture.restitutionThreshold = threshold_;
    drum_->CreateFixture(&fixture);
  }

  void add_grain(const Scene& scene, const Grain& grain) {
    b2BodyDef body;
    body.type = b2_dynamicBody;
    body.position.Set(static_cast<float>(grain.x * units_per_metre),
                      static_cast<float>(grain.z * units_per_metre));
    body.linearVelocity.Set(static_cast<float>(grain.v_x * units_per_metre),
                            static_cast<float>(grain.v_z * units_per_metre));
    body.angularVelocity = static_cast<float>(-grain.spin);
    b2CircleShape shape;
    shape.m_radius = static_cast<float>(grain.radius * units_per_metre);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = 1;  // only ratios matter
    fixture.friction = static_cast<float>(scene.effects.friction->grain_grain);
    fixture.restitution = static_cast<float>(scene.effects.restitution->grain_grain);
    fixture.restitutionThreshold = threshold_;
    world_.CreateBody(&body)->CreateFixture(&fixture);
  }

  double diameter_;
  float threshold_ = 0;
  b2World world_;
  b2Body* drum_ = nullptr;
  double overlap_sum_ = 0, overlap_max_ = 0, contacts_ = 0, samples_ = 0, slope_sum_ = 0;
};

double spin_rad_s(const Stage& stage) {
  for (const WallMotion& motion : stage.motions)
    if (const auto* rotation = std::get_if<Rotation>(&motion.motion))
      return rotation->speed_rpm * 2 * std::numbers::pi / 60;
  return 0;
}

struct Measured {
  double wall_seconds = 0, processor_seconds = 0;
  std::int64_t steps = 0;
};

/// `steps` of one stage; overlaps are looked at if `sampled`.
Measured advance(Box2dDrum& drum, const Stage& stage, double time_step_s, std::int64_t steps, bool sampled) {
  drum.turn(spin_rad_s(stage));
  Measured measured{0, 0, steps};
  for (std::int64_t k = 1; k <= steps; ++k) {
    const auto wall = std::chrono::steady_clock::now();
    const double processor = process_seconds();
    drum.step(time_step_s);
    measured.processor_seconds += process_seconds() - processor;
    measured.wall_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
    if (sampled && k % sample_every == 0) drum.sample_overlaps();
  }
  return measured;
}

Json to_json(const Measured& m) {
  return {{"steps", m.steps},
          {"wall_seconds", m.wall_seconds},
          {"processor_seconds", m.processor_seconds},
          {"processor_ms_per_step", 1e3 * m.processor_seconds / static_cast<double>(m.steps)}};
}

int measure(const std::vector<std::string>& words) {
  std::optional<Snapshot> from;
  double seconds = 0, skip = 0;
  for (std::size_t k = 2; k + 1 < words.size(); k += 2) {
    if (words[k] == "--from") from = read_snapshot(words[k + 1]);
    if (words[k] == "--seconds") seconds = checked_number(words[k + 1], {"command line", 0, words[k]});
    if (words[k] == "--skip") skip = checked_number(words[k + 1], {"command line", 0, words[k]});
  }
  const Scene scene = read_scene(words.at(0));
  const Scales scales = scales_of(scene);
  const TimePlan plan = time_plan(scene, scales);
  Box2dDrum drum(scene, scales, grains_at_start(scene, scales, from));
  Json result{{"format", "drumlin-box2d-1"},
              {"scene", scene.title},
              {"box2d", fmt::format("{}.{}.{}", b2_version.major, b2_version.minor, b2_version.revision)},
              {"velocity_iterations", velocity_iterations},
              {"position_iterations", position_iterations},
              {"units_per_metre", units_per_metre},
              {"drum_edges", drum_edges},
              {"threads", 1}};
  result["command"] = "benchmark_box2d SCENE RESULT";
  for (std::size_t k = 2; k < words.size(); ++k)
    if (words[k].starts_with("--"))
      result["command"] = result["command"].get<std::string>() + " " + words[k] +
                          (words[k] == "--from" ? " SNAPSHOT" : " " + words.at(k + 1));
  Measured counted;
  if (from) {
    const Stage& stage = scene.stages.back();
    const double h = plan.stages.back().time_step * scales.time_s;
    (void)advance(drum, stage, h, std::llround(skip / h), false);
    counted = advance(drum, stage, h, std::llround((seconds - skip) / h), true);
    result["extrapolated"] = true;
    result["stretch"] = to_json(counted);
  } else {
    result["extrapolated"] = false;
    for (std::size_t s = 0; s < scene.stages.size(); ++s) {
      const bool last = s + 1 == scene.stages.size();
      const Measured m = advance(drum, scene.stages[s], plan.stages[s].time_step * scales.time_s,
                                 plan.stages[s].steps, last);
      result["stages"][scene.stages[s].name] = to_json(m);
      counted.steps += m.steps, counted.wall_seconds += m.wall_seconds,
          counted.processor_seconds += m.processor_seconds;
    }
  }
  const double whole = static_cast<double>(plan.steps) / static_cast<double>(counted.steps);
  result["whole"] = {{"steps", plan.steps},
                     {"wall_seconds", counted.wall_seconds * whole},
                     {"processor_seconds", counted.processor_seconds * whole}};
  result["accuracy"] = drum.accuracy();
  result["provenance"] = apps::to_json(provenance());
  apps::write_json(words.at(1), result);
  fmt::print("{}\n", result.dump(2));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc % 2 == 0) {
    fmt::print(stderr,
               "usage: benchmark_box2d SCENE.toml RESULT.json [--from SNAPSHOT.h5 --seconds S [--skip S]]\n");
    return static_cast<int>(ExitCode::wrong_input);
  }
  try {
    return measure({argv + 1, argv + argc});
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return static_cast<int>(ExitCode::wrong_input);
  }
}
