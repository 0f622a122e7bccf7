// The flowing drum of a scene in Box2D 2.4 and in our engine, in turn (drum_race.hpp): the same grains and
// time steps, its own contact solver.
#include <box2d/box2d.h>
#include <fmt/format.h>

#include "tests/benchmarks/drum_race.hpp"

namespace {

using namespace drumlin::benchmark;

b2Vec2 scaled(double x, double z) {
  return {static_cast<float>(x * units_per_metre), static_cast<float>(z * units_per_metre)};
}

class Box2dDrum final : public DrumEngine {
 public:
  Box2dDrum(const FlowingDrum& drum, const EngineSettings& settings)
      : time_step_(static_cast<float>(drum.time_step)),
        velocity_iterations_(static_cast<int>(settings.at("velocity_iterations"))),
        position_iterations_(static_cast<int>(settings.at("position_iterations"))),
        diameter_(drum.diameter * units_per_metre),
        world_(scaled(drum.gravity_x, drum.gravity_z)) {
    world_.SetAllowSleeping(false);
    // Grains move by less than themselves in a step: without continuous collision Box2D is faster.
    world_.SetContinuousPhysics(false);
    add_drum(drum);
    for (const FlowingDrum::Grain& grain : drum.grains) add_grain(drum, grain);
  }

  void step() override { world_.Step(time_step_, velocity_iterations_, position_iterations_); }

  void look(Looks& looks) const override {
    for (const b2Contact* contact = world_.GetContactList(); contact != nullptr;
         contact = contact->GetNext()) {
      const b2Manifold& manifold = *contact->GetManifold();
      if (!contact->IsTouching() || manifold.pointCount == 0 || manifold.points[0].normalImpulse <= 0)
        continue;
      b2WorldManifold places;
      contact->GetWorldManifold(&places);
      looks.add_contact(-static_cast<double>(places.separations[0]) / diameter_);
    }
    double x = 0, z = 0;
    for (const b2Body* body = world_.GetBodyList(); body != nullptr; body = body->GetNext())
      if (body != drum_)
        x += body->GetMass() * body->GetPosition().x, z += body->GetMass() * body->GetPosition().y;
    looks.add_look(x, z);
  }

 private:
  void add_drum(const FlowingDrum& drum) {
    std::vector<b2Vec2> corners;
    for (int k = 0; k < drum_edges; ++k)  // clockwise: the solid side is outside
      corners.push_back(scaled(drum.radius * drum_corner(k).x, drum.radius * drum_corner(k).z));
    b2ChainShape shape;
    shape.CreateLoop(corners.data(), drum_edges);
    b2BodyDef body;
    body.type = b2_kinematicBody;
    body.angularVelocity = static_cast<float>(-drum.spin);
    drum_ = world_.CreateBody(&body);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    // Box2D takes the geometric mean of two bodies for a contact.
    fixture.friction = static_cast<float>(drum.friction_drum * drum.friction_drum / drum.friction_grains);
    fixture.restitution = static_cast<float>(drum.restitution_drum);
    fixture.restitutionThreshold = static_cast<float>(drum.resting_speed * units_per_metre);
    drum_->CreateFixture(&fixture);
  }

  void add_grain(const FlowingDrum& drum, const FlowingDrum::Grain& grain) {
    b2BodyDef body;
    body.type = b2_dynamicBody;
    body.position = scaled(grain.x, grain.z);
    body.linearVelocity = scaled(grain.v_x, grain.v_z);
    body.angularVelocity = static_cast<float>(-grain.spin);
    b2CircleShape shape;
    shape.m_radius = static_cast<float>(grain.radius * units_per_metre);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = 1;  // only ratios matter
    fixture.friction = static_cast<float>(drum.friction_grains);
    fixture.restitution = static_cast<float>(drum.restitution_grains);
    fixture.restitutionThreshold = static_cast<float>(drum.resting_speed * units_per_metre);
    world_.CreateBody(&body)->CreateFixture(&fixture);
  }

  float time_step_;
  int velocity_iterations_, position_iterations_;
  double diameter_;
  b2World world_;
  b2Body* drum_ = nullptr;
};

}  // namespace

int main(int argc, char** argv) {
  return race_drums(argc, argv,
                    {"box2d",
                     fmt::format("{}.{}.{}", b2_version.major, b2_version.minor, b2_version.revision),
                     {{"velocity_iterations", 20}, {"position_iterations", 10}},
                     [](const FlowingDrum& drum, const EngineSettings& settings) {
                       return std::make_unique<Box2dDrum>(drum, settings);
                     }});
}
