#pragma once
// The effects of a scene: what an effect is, and the one list of them.
//
// An effect is one file. It holds a struct of keys, describe() for these, and law_of(keys, LawInput), which
// makes of them a law in the units of the simulation. The struct of keys has
//   name, sentence: as the scene file shows them
//   modest(), modest_text: a strength to try, and the words for it
// and what of this it needs
//   check(scene, refuse): what it asks of the rest of the scene
//   contact_law: that of contacts (contact_law/contact_laws-inl.h); of several the last in the list
//   account: its column of energy.csv
//
// A step goes through the laws of a scene, and calls those of these members that a law has:
//   move_freely(bodies, begin, end, h, free): velocities of some grains after a step without contacts;
//     with changes_inertia it scales free.inverse_mass, with which they answer impulses
//   turn_freely(bodies, h): spins after a step without contacts
//   attraction(pair, materials): a force that pulls two surfaces together, up to a gap of `range`
//   friction(mu, sliding velocity, pair, materials): what becomes of the coefficient of friction
//   sliding_friction(mu, pair, materials): what becomes of it where the contact slides, or an impact begins
//   coefficient(pair, materials): the second one of the contact law
//   radius_ratio(), couple_velocity(), wall_part(): a couple, the third unknown of a contact
//   work(before, now, h): what a step gave the grains, beside the work of attraction and couple
// A member that a law lacks costs nothing, nor does a law that the scene does not name: the compiler knows
// which law has what.
#include <optional>
#include <type_traits>

#include "particles/effects/cohesion.hpp"
#include "particles/effects/drag.hpp"
#include "particles/effects/dynamic_friction.hpp"
#include "particles/effects/friction.hpp"
#include "particles/effects/gravity.hpp"
#include "particles/effects/kinetic_friction.hpp"
#include "particles/effects/restitution.hpp"
#include "particles/effects/rolling.hpp"
#include "particles/effects/rotating_frame.hpp"
#include "particles/effects/spin.hpp"

namespace drumlin::particles {

/// Something for each effect, by its name: Of<E> for effect E.
template <template <class> class Of>
struct EffectsOf {
  Of<Gravity> gravity = {};
  Of<Friction> friction = {};
  Of<Restitution> restitution = {};
  Of<Spin> spin = {};
  Of<RollingResistance> rolling_resistance = {};
  Of<Cohesion> cohesion = {};
  Of<RotatingFrame> rotating_frame = {};
  Of<Drag> drag = {};
  Of<DynamicFriction> dynamic_friction = {};
  Of<KineticFriction> kinetic_friction = {};
};

/// Calls visit(what each of the lists has for it) for one effect after the other.
template <class Visit, class... Lists>
void each_effect(Visit visit, Lists&&... lists) {
  visit(lists.gravity...);
  visit(lists.friction...);
  visit(lists.restitution...);
  visit(lists.spin...);
  visit(lists.rolling_resistance...);
  visit(lists.cohesion...);
  visit(lists.rotating_frame...);
  visit(lists.drag...);
  visit(lists.dynamic_friction...);
  visit(lists.kinetic_friction...);
}

/// What an effect does not have.
struct Absent {};

/// The effects that a scene names. What is absent is neither stored nor computed.
using Effects = EffectsOf<std::optional>;

/// Their laws.
template <class E>
using LawOf = std::optional<decltype(law_of(std::declval<const E&>(), std::declval<const LawInput&>()))>;

/// Calls visit(law) for each law that is there.
template <class Visit>
void each_law(const EffectsOf<LawOf>& laws, Visit visit) {
  each_effect(
      [&visit](const auto& law) {
        if (law) visit(*law);
      },
      laws);
}

/// Whether an effect has values for pairs of materials, which a stage can replace.
template <class E>
concept HasPairs = requires(E effect) {
  effect.pairs;
};
template <class E>
using InStage = std::conditional_t<HasPairs<E>, std::optional<StageValues<E>>, Absent>;
using StageEffects = EffectsOf<InStage>;

/// The work of each effect on the grains since the start, if the scene has it.
template <class E>
using WorkOf = std::optional<double>;

/// Calls visit(name, work) for each account that there can be.
template <class Works, class Visit>
void each_account(Works& works, Visit visit) {
  each_effect(
      [&visit]<class E>(auto& work, const std::optional<E>&) {
        if constexpr (requires { E::account; }) visit(std::string(E::account), work);
      },
      works, Effects{});
}

/// The law of contacts with these effects.
inline ContactLaw contact_law_of(const Effects& effects) {
  ContactLaw law = Frictionless{};
  each_effect(
      [&law]<class E>(const std::optional<E>& effect) {
        if constexpr (requires { typename E::contact_law; })
          if (effect) law = typename E::contact_law{};
      },
      effects);
  return law;
}
inline int unknowns_of(const ContactLaw& law) {
  return std::visit([](auto own) { return own.unknowns; }, law);
}

}  // namespace drumlin::particles
