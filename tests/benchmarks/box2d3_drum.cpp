// The flowing drum of a scene in Box2D 3 and in our engine, in turn (drum_race.hpp): the same grains and time
// steps, its own contact solver, soft contacts solved in substeps.
#include <box2d/box2d.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/benchmarks/drum_race.hpp"

namespace {

using namespace drumlin::benchmark;

b2Vec2 scaled(double x, double z) {
  return {static_cast<float>(x * units_per_metre), static_cast<float>(z * units_per_metre)};
}

double distance_to_segment(b2Vec2 p, b2Vec2 a, b2Vec2 b) {
  const double x = b.x - a.x, z = b.y - a.y;
  const double along = ((p.x - a.x) * x + (p.y - a.y) * z) / (x * x + z * z);
  const double s = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.x - (a.x + s * x), p.y - (a.y + s * z));
}

class Box2d3Drum final : public DrumEngine {
 public:
  Box2d3Drum(const FlowingDrum& drum, const EngineSettings& settings)
      : time_step_(static_cast<float>(drum.time_step)),
        substeps_(static_cast<int>(settings.at("substeps"))),
        diameter_(drum.diameter * units_per_metre) {
    // The permitted slop, 0.005 units, and all lengths of Box2D that follow from it; before anything is made.
    b2SetLengthUnitsPerMeter(static_cast<float>(settings.at("length_unit")));
    b2WorldDef world = b2DefaultWorldDef();
    world.gravity = scaled(drum.gravity_x, drum.gravity_z);
    world.restitutionThreshold = static_cast<float>(drum.resting_speed * units_per_metre);
    world.contactHertz = static_cast<float>(settings.at("contact_hertz"));
    world.contactDampingRatio = static_cast<float>(settings.at("contact_damping"));
    world.contactSpeed = static_cast<float>(settings.at("contact_speed"));
    world.maximumLinearSpeed = 1e5F;  // its own limit would be 0.4 m/s here
    world.enableSleep = false;
    world.enableContinuous = false;  // grains move by less than themselves in a step
    world.workerCount = 1;
    world_ = b2CreateWorld(&world);
    if (settings.at("recycling") == 0) b2World_SetContactRecycleDistance(world_, 0);
    add_drum(drum);
    for (const FlowingDrum::Grain& grain : drum.grains) add_grain(drum, grain);
  }
  ~Box2d3Drum() override { b2DestroyWorld(world_); }
  Box2d3Drum(const Box2d3Drum&) = delete;
  Box2d3Drum& operator=(const Box2d3Drum&) = delete;

  void step() override { b2World_Step(world_, time_step_, substeps_); }

  void look(Looks& looks) const override {
    std::vector<b2ContactData> contacts;
    double x = 0, z = 0;
    for (const b2BodyId body : grains_) {
      const b2Vec2 place = b2Body_GetPosition(body);
      const double mass = b2Body_GetMass(body);
      x += mass * place.x, z += mass * place.y;
      contacts.resize(b2Body_GetContactCapacity(body));
      const int count = b2Body_GetContactData(body, contacts.data(), static_cast<int>(contacts.size()));
      for (int c = 0; c < count; ++c) look_at(contacts[c], body, looks);
    }
    looks.add_look(x, z);
  }

 private:
  /// Adds a contact of a grain, if this grain is the second of its two bodies: each contact counts once.
  void look_at(const b2ContactData& contact, b2BodyId grain, Looks& looks) const {
    b2ShapeId other = contact.shapeIdA, own = contact.shapeIdB;
    const bool of_drum =
        b2Shape_GetType(other) == b2_chainSegmentShape || b2Shape_GetType(own) == b2_chainSegmentShape;
    if (of_drum && b2Shape_GetType(own) == b2_chainSegmentShape) std::swap(other, own);
    if (!of_drum && !B2_ID_EQUALS(b2Shape_GetBody(own), grain)) return;
    if (contact.manifold.pointCount == 0 || contact.manifold.points[0].totalNormalImpulse <= 0) return;
    // From the places of the bodies: separations that Box2D keeps are approximate where contacts are reused.
    const b2Vec2 place = b2Body_GetPosition(grain);
    const double radius = b2Shape_GetCircle(own).radius;
    double distance = 0;
    if (of_drum) {
      const b2Segment edge = b2Shape_GetChainSegment(other).segment;
      distance = distance_to_segment(place, b2Body_GetWorldPoint(drum_, edge.point1),
                                     b2Body_GetWorldPoint(drum_, edge.point2));
    } else {
      const b2Vec2 second = b2Body_GetPosition(b2Shape_GetBody(other));
      distance = std::hypot(place.x - second.x, place.y - second.y) - b2Shape_GetCircle(other).radius;
    }
    looks.add_contact((radius - distance) / diameter_);
  }

  void add_drum(const FlowingDrum& drum) {
    std::vector<b2Vec2> corners;
    for (int k = 0; k < drum_edges; ++k)  // clockwise: the solid side is outside
      corners.push_back(scaled(drum.radius * drum_corner(k).x, drum.radius * drum_corner(k).z));
    b2BodyDef body = b2DefaultBodyDef();
    body.type = b2_kinematicBody;
    body.angularVelocity = static_cast<float>(-drum.spin);
    drum_ = b2CreateBody(world_, &body);
    b2SurfaceMaterial material = b2DefaultSurfaceMaterial();
    // Box2D takes the geometric mean of two bodies for a contact.
    material.friction = static_cast<float>(drum.friction_drum * drum.friction_drum / drum.friction_grains);
    material.restitution = static_cast<float>(drum.restitution_drum);
    b2ChainDef chain = b2DefaultChainDef();
    chain.points = corners.data();
    chain.count = drum_edges;
    chain.isLoop = true;
    chain.materials = &material;
    chain.materialCount = 1;
    b2CreateChain(drum_, &chain);
  }

  void add_grain(const FlowingDrum& drum, const FlowingDrum::Grain& grain) {
    b2BodyDef body = b2DefaultBodyDef();
    body.type = b2_dynamicBody;
    body.position = scaled(grain.x, grain.z);
    body.linearVelocity = scaled(grain.v_x, grain.v_z);
    body.angularVelocity = static_cast<float>(-grain.spin);
    grains_.push_back(b2CreateBody(world_, &body));
    b2ShapeDef shape = b2DefaultShapeDef();
    shape.density = 1;  // only ratios matter
    shape.material.friction = static_cast<float>(drum.friction_grains);
    shape.material.restitution = static_cast<float>(drum.restitution_grains);
    const b2Circle circle{{0, 0}, static_cast<float>(grain.radius * units_per_metre)};
    b2CreateCircleShape(grains_.back(), &shape, &circle);
  }

  float time_step_;
  int substeps_;
  double diameter_;
  b2WorldId world_{};
  b2BodyId drum_{};
  std::vector<b2BodyId> grains_;
};

}  // namespace

int main(int argc, char** argv) {
  const b2Version version = b2GetVersion();
  return race_drums(
      argc, argv,
      {"box2d3",
       fmt::format("{}.{}.{} {}", version.major, version.minor, version.revision, DRUMLIN_BOX2D3_REVISION),
       {{"substeps", 16},
        {"contact_hertz", 4000},
        {"contact_damping", 10},
        {"contact_speed", 1000},
        {"length_unit", 1},
        {"recycling", 1}},
       [](const FlowingDrum& drum, const EngineSettings& settings) {
         return std::make_unique<Box2d3Drum>(drum, settings);
       }});
}
