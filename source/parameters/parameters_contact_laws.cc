#include "parameters/plugin_keys.h"
#include <nodus/plugins/friction_law.h>
#include <nodus/plugins/pressure_gap_law.h>

// The keys of the laws of a contact pair: contact, pressure-gap law, friction.

namespace Nodus
{
  namespace
  {
    using namespace ParameterKeys;

    const Names<ContactPairParameters::ContactLaw> contact_law_names = {
        {ContactPairParameters::ContactLaw::unilateral, "unilateral"},
        {ContactPairParameters::ContactLaw::bilateral, "bilateral"},
        {ContactPairParameters::ContactLaw::tied, "tied"}};

    const Names<ContactPairParameters::FrictionLaw> friction_law_names = {
        {ContactPairParameters::FrictionLaw::coulomb, "Coulomb"},
        {ContactPairParameters::FrictionLaw::tresca, "Tresca"}};

    const Names<PressureGapParameters::Law> pressure_gap_names = {
        {PressureGapParameters::Law::hard, "hard"},
        {PressureGapParameters::Law::linear, "linear"},
        {PressureGapParameters::Law::exponential, "exponential"},
        {PressureGapParameters::Law::table, "table"}};
  } // namespace

  std::string text_of(const ContactPairParameters::ContactLaw law)
  {
    return text_of(law, contact_law_names);
  }

  std::string text_of(const PressureGapParameters::Law law)
  {
    return text_of(law, pressure_gap_names);
  }

  namespace
  {
    /// What the surfaces do once closed, and how they rub.
    void add_laws(ParameterHandler &prm, ContactPairParameters &pair)
    {
      add_choice(prm,
                 "Contact law",
                 pair.contact_law,
                 contact_law_names,
                 "What the surfaces do once closed [-]: push only, or never open again but slide, or stay tied where "
                 "they start.");
      add_choice(prm,
                 "Friction law",
                 pair.friction_law,
                 friction_law_names,
                 ContactPairParameters::FrictionLaw::own,
                 pair.own_friction_law,
                 "Limit of the friction traction [-]: friction coefficient times pressure, or the shear limit.");
      prm.add_parameter("Friction coefficient",
                        pair.friction_coefficient,
                        "Coulomb's coefficient [-]; 0: no friction.",
                        not_negative);
      prm.add_parameter("Second friction coefficient",
                        pair.second_friction_coefficient,
                        "Of orthotropic friction, across the friction direction [-]; 0: as the first one. The limits "
                        "are the half axes of an ellipse, and slip is normal to it.",
                        not_negative);
      prm.add_parameter("Friction direction",
                        pair.friction_direction,
                        "Of orthotropic friction: direction in space of the first coefficient, projected on the "
                        "surface [-]; three numbers.");
      prm.add_parameter(
          "Friction factor",
          pair.friction_factor,
          "Factor on the friction coefficients, of Tresca on the shear limit [-]: expression of the "
          "reference coordinates x, y, z [length], of the slip rate v [length/time] and of the time t [-], e.g. "
          "0.6+0.4*exp(-v/10), or t>1 for friction that sets in after t = 1. The slip rate is the slip of "
          "the increment over its time.",
          Patterns::Anything());
      prm.add_parameter("Shear limit",
                        pair.shear_limit,
                        "Friction tractions do not exceed this [pressure]; 0: no limit (Coulomb).",
                        not_negative);
      prm.add_parameter("Elastic slip",
                        pair.elastic_slip,
                        "Slip over which the friction traction grows to its limit, and which comes back when it goes "
                        "[length]; 0: none, surfaces that stick do not move against each other. Small against "
                        "everything of interest it takes the edge off friction; larger it is the shear of a layer.",
                        not_negative);
    }

    /// How closed surfaces give way.
    void add_pressure_gap(ParameterHandler &prm, PressureGapParameters &gap)
    {
      add_choice(prm,
                 "Pressure-gap law",
                 gap.law,
                 pressure_gap_names,
                 PressureGapParameters::Law::own,
                 gap.own_law,
                 "Overclosure d, minus the gap, of surfaces under the pressure p [-]: hard, none; linear, p = k d; "
                 "exponential, p = k l (exp(d/l) - 1); table. For coatings, gaskets and rough surfaces that the mesh "
                 "does not show.");
      prm.add_parameter("Contact stiffness",
                        gap.stiffness,
                        "Of a linear or exponential pressure-gap law: k, pressure per overclosure where the surfaces "
                        "begin to touch [pressure/length], > 0.",
                        not_negative);
      prm.add_parameter("Stiffening length",
                        gap.stiffening_length,
                        "Of an exponential pressure-gap law: l, overclosure over which the stiffness grows by the "
                        "factor e [length], > 0.",
                        not_negative);
      prm.add_parameter("Gap law overclosures",
                        gap.overclosures,
                        "Of a pressure-gap law by table: overclosures, not decreasing [length]; the first one, at "
                        "pressure 0, may be negative: surfaces touch before they meet. The law is linear in between "
                        "and behind the last one.",
                        numbers);
      prm.add_parameter("Gap law pressures",
                        gap.pressures,
                        "Of a pressure-gap law by table: pressures at these overclosures, the first 0, increasing "
                        "[pressure].",
                        numbers);
    }

    /// What tightens a bolt.
    void add_preload(ParameterHandler &prm, ContactPairParameters::Preload &preload)
    {
      prm.add_parameter("Preload",
                        preload.force,
                        "Of a tied pair whose sides are the two faces of a cut through a bolt: force in the bolt "
                        "[force], tension positive, an expression of the time t [-], e.g. 1e4*min(t,1). The faces move "
                        "past each other along the axis, by as much as equilibrium needs, and stay tied otherwise. "
                        "Empty: the pair is no such section.",
                        Patterns::Anything());
      prm.add_parameter("Preload until",
                        preload.until,
                        "Time until which that force acts [-]: one of the Interval ends; 0: all the time. From then on "
                        "the bolt keeps the length that it has been tightened to, and its force follows the loads.",
                        not_negative);
      prm.add_parameter("Preload axis",
                        preload.axis,
                        "Axis of the bolt in the reference configuration, in either direction [-]; three numbers. "
                        "Zero: the mean normal of the slave faces.");
    }
  } // namespace

  namespace ParameterKeys
  {
    void add_contact_laws(ParameterHandler &prm, ContactPairParameters &pair)
    {
      add_laws(prm, pair);
      add_pressure_gap(prm, pair.pressure_gap);
      add_preload(prm, pair.preload);
    }
  } // namespace ParameterKeys
} // namespace Nodus
