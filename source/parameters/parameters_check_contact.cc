#include "parameters/expression.h"
#include "parameters/general_contact.h"
#include "parameters/parameter_checks.h"

#include <algorithm>
#include <filesystem>

// Contact pairs, and what they share with bodies and boundary conditions.

namespace Nodus
{
  void ParameterChecks::check_expression(const Section     &section,
                                         const std::string &key,
                                         const std::string &text,
                                         const std::string &variables)
  {
    const std::string problem = expression_complaint(text, variables);
    std::string       names;
    for (const char c : variables)
      names += c == ',' ? ", " : std::string(1, c);
    section.require(problem.empty(),
                    key,
                    "has the expression '" + text + "' that does not parse: " + problem +
                        (variables == "t" ? "; the variable is t" : "; variables are " + names) + ", constants pi");
  }

  void ParameterChecks::check(const Section          &section,
                              const RegionParameters &region,
                              const std::string      &prefix,
                              const unsigned int      n_bodies,
                              const unsigned int      smallest_body)
  {
    const std::string choice = (smallest_body == 0 ? "0 (every body) to " : "1 to ") + std::to_string(n_bodies);
    section.require(smallest_body == 0 || !region.bodies.empty(),
                    prefixed(prefix, "Body"),
                    "is 0; give the number of a body, " + choice);
    for (const unsigned int body : region.bodies)
    {
      section.require(body >= 1 && body <= n_bodies,
                      prefixed(prefix, "Body"),
                      (region.bodies.size() == 1 ? "is " : "has ") + std::to_string(body) +
                          "; give the number of a body, " +
                          (region.bodies.size() == 1 ? choice : "1 to " + std::to_string(n_bodies)));
      section.require(std::count(region.bodies.begin(), region.bodies.end(), body) == 1,
                      prefixed(prefix, "Body"),
                      "has " + std::to_string(body) + " twice; name each body once");
    }
    for (const auto &[body, ids] : region.ids_of_body)
      section.require(region.has_body(body),
                      prefixed(prefix, "Boundary ids"),
                      "has ids of body " + std::to_string(body) + ", which is not in '" + prefixed(prefix, "Body") +
                          "'");
    if (!region.where.empty())
      check_expression(section, prefixed(prefix, "Where"), region.where, variables_of_faces);
  }

  void ParameterChecks::check(const Section                    &section,
                              const PrescribedMotionParameters &motion,
                              const std::string                &prefix,
                              const Vector3                    &axis)
  {
    section.require(motion.translation.size() == dim,
                    prefixed(prefix, "Translation"),
                    "has " + std::to_string(motion.translation.size()) +
                        " expressions; give three, separated by ';', for example 0; 0; -0.1*t");
    for (const std::string &expression : motion.translation)
      check_expression(section, prefixed(prefix, "Translation"), expression, "t");
    check_expression(section, prefixed(prefix, "Rotation"), motion.rotation, "t");
    section.require(motion.rotation == "0" || (motion.rotation_axis + axis).norm() > 0.,
                    prefixed(prefix, "Rotation axis"),
                    "must not be zero when there is a Rotation; give a direction such as 0, 0, 1");
    section.require(motion.rotation_centre.empty() || motion.rotation_centre.size() == dim,
                    prefixed(prefix, "Rotation centre"),
                    "has " + std::to_string(motion.rotation_centre.size()) + " numbers; give three, or none");
  }

  void ParameterChecks::check(const Section             &section,
                              const ActiveTime          &time,
                              const std::string         &what,
                              const std::vector<double> &interval_ends)
  {
    for (const auto &[key, t] :
         {std::pair<const char *, double>("Active from", time.active_from), {"Active until", time.active_until}})
      section.require(t == 0. || std::count(interval_ends.begin(), interval_ends.end(), t) > 0,
                      key,
                      "must be 0 or one of the times in Load stepping / Interval ends; add it there");
    section.require(time.active_until == 0. || time.active_until > time.active_from,
                    "Active until",
                    "is not after Active from; the " + what + " would never act");
    section.require(time.active_from == 0. || time.active_from < interval_ends.back(),
                    "Active from",
                    "is the end of the load path; the " + what + " would never act");
  }

  bool ParameterChecks::is_given(const PrescribedMotionParameters &motion)
  {
    const PrescribedMotionParameters none;
    return motion.translation != none.translation || motion.rotation != none.rotation ||
           motion.rotation_axis != none.rotation_axis || !motion.rotation_centre.empty();
  }

  bool ParameterChecks::share_faces(const RegionParameters &a, const RegionParameters &b)
  {
    if (a.where != b.where)
      return false;
    for (const unsigned int body : a.bodies)
    {
      const auto in_b = [&](const dealii::types::boundary_id id) { return b.takes(body, id); };
      const auto own  = a.ids_of_body.find(body);
      if (!a.has_ids() && b.has_body(body))
        return true;
      if (std::any_of(a.boundary_ids.begin(), a.boundary_ids.end(), in_b) ||
          (own != a.ids_of_body.end() && std::any_of(own->second.begin(), own->second.end(), in_b)))
        return true;
    }
    return false;
  }

  namespace
  {
    using namespace ParameterChecks;

    void check_friction(const Section &section, const ContactPairParameters &pair)
    {
      const bool tied    = pair.contact_law == ContactPairParameters::ContactLaw::tied,
                 coulomb = pair.friction_coefficient > 0.,
                 own     = pair.friction_law == ContactPairParameters::FrictionLaw::own;
      for (const auto &[key, given] :
           {Given("Friction coefficient", coulomb),
            Given("Shear limit", pair.shear_limit > 0.),
            Given("Initial overclosure", pair.start.overclosure != ContactPairParameters::InitialOverclosure::resolve)})
        section.require(!tied || !given, key, "has no effect on a tied pair; remove it");
      section.require(pair.contact_law == ContactPairParameters::ContactLaw::unilateral ||
                          pair.start.overclosure == ContactPairParameters::InitialOverclosure::resolve,
                      "Initial overclosure",
                      "has no effect on a bilateral pair, which is always adjusted; remove it");
      section.require(!tied || pair.start.status != ContactPairParameters::InitialStatus::open,
                      "Initial status",
                      "is open, but a tied pair never closes later; remove it");
      if (pair.friction_law == ContactPairParameters::FrictionLaw::tresca)
      {
        section.require(!tied, "Friction law", "has no effect on a tied pair; remove it");
        section.require(pair.shear_limit > 0., "Shear limit", "must be given and > 0: it is the friction of Tresca");
        section.require(!coulomb, "Friction coefficient", "has no effect on 'Friction law = Tresca'; remove it");
      }
      else if (own)
      {
        section.require(!tied, "Friction law", "has no effect on a tied pair; remove it");
        const std::string no_effect = "has no effect on 'Friction law = " + pair.own_friction_law.name + "'; remove it";
        section.require(!coulomb, "Friction coefficient", no_effect);
        section.require(pair.friction_factor == "1", "Friction factor", no_effect);
      }
      else
        section.require(coulomb || pair.shear_limit == 0.,
                        "Shear limit",
                        "limits a friction that is 0; give a Friction coefficient, or set 'Friction law = Tresca'");
      const bool second = pair.second_friction_coefficient > 0., direction = pair.friction_direction != Vector3();
      section.require(!second || coulomb, "Second friction coefficient", "needs a Friction coefficient > 0");
      section.require(!second || direction, "Friction direction", "is missing; give that of the first coefficient");
      section.require(second || !direction,
                      "Friction direction",
                      "has no effect without a Second friction coefficient; remove it or give that");
      section.require(pair.elastic_slip == 0. || coulomb || own ||
                          pair.friction_law == ContactPairParameters::FrictionLaw::tresca,
                      "Elastic slip",
                      "has no effect without friction; give a Friction coefficient");
      const bool factor = pair.friction_factor != "1";
      section.require(!factor || coulomb || pair.friction_law == ContactPairParameters::FrictionLaw::tresca,
                      "Friction factor",
                      "has no effect without friction; give a Friction coefficient");
      if (factor)
        check_expression(section, "Friction factor", pair.friction_factor, "x,y,z,v,t");
    }

    void check_gap_law(const Section &section, const ContactPairParameters &pair)
    {
      using Law                        = PressureGapParameters::Law;
      const PressureGapParameters &gap = pair.pressure_gap;
      section.require(gap.law == Law::hard || pair.contact_law != ContactPairParameters::ContactLaw::tied,
                      "Pressure-gap law",
                      "has no effect on a tied pair; remove it");
      const std::string law =
          "'Pressure-gap law = " + (gap.law == Law::own ? gap.own_law.name : text_of(gap.law)) + "'";
      for (const auto &[key, given, used] :
           {std::make_tuple(
                "Contact stiffness", gap.stiffness > 0., gap.law == Law::linear || gap.law == Law::exponential),
            std::make_tuple("Stiffening length", gap.stiffening_length > 0., gap.law == Law::exponential),
            std::make_tuple("Gap law overclosures", !gap.overclosures.empty(), gap.law == Law::table),
            std::make_tuple("Gap law pressures", !gap.pressures.empty(), gap.law == Law::table)})
      {
        section.require(given || !used, key, "is missing; " + law + " needs it");
        section.require(used || !given, key, "has no effect on " + law + "; remove it");
      }
      if (gap.law != Law::table)
        return;
      section.require(gap.pressures.size() == gap.overclosures.size() && gap.pressures.size() >= 2,
                      "Gap law pressures",
                      "needs as many numbers as Gap law overclosures has, at least 2");
      section.require(gap.pressures[0] == 0., "Gap law pressures", "begins with 0, where surfaces begin to touch");
      for (unsigned int i = 1; i < gap.pressures.size(); ++i)
      {
        section.require(gap.pressures[i] > gap.pressures[i - 1], "Gap law pressures", "has to increase");
        section.require(gap.overclosures[i] >= gap.overclosures[i - 1], "Gap law overclosures", "must not decrease");
      }
    }

    /// What a rigid surface is given by.
    void check_shape(const Section &section, const MasterSurfaceParameters &surface, const std::string &shape)
    {
      using Shape      = MasterSurfaceParameters::Shape;
      const bool plane = surface.shape == Shape::plane, triangles = surface.shape == Shape::triangles;
      if (triangles)
      {
        std::error_code unknown;
        section.require(!surface.file.empty(), "Master file", "is missing; give the STL file of the triangles");
        section.require(std::filesystem::is_regular_file(surface.file, unknown),
                        "Master file",
                        "is no file: " + surface.file + "; names are relative to the folder of the .prm file");
        for (const auto &[key, given] :
             {Given("Master radius", surface.radius != 0.), Given("Master axis", surface.axis != Vector3())})
          section.require(!given, key, "has no meaning for triangles; remove it, their file has the shape");
        return;
      }
      for (const auto &[key, given] :
           {Given("Master file", !surface.file.empty()), Given("Master scale", surface.scale != 1.)})
        section.require(
            !given, key, "has no meaning for a " + shape + "; remove it, or set 'Master surface = triangles'");
      section.require(plane || surface.radius > 0., "Master radius", "must be given and > 0 for a " + shape);
      section.require(!plane || surface.radius == 0., "Master radius", "has no meaning for a plane; remove it");
      section.require(
          !plane || !surface.cavity,
          "Master cavity",
          "has no meaning for a plane; remove it, the body is on the side that Master axis points away from");
      section.require(surface.shape == Shape::sphere || surface.axis.norm() > 0.,
                      "Master axis",
                      std::string("must be given and not zero: ") +
                          (surface.shape == Shape::cylinder ? "the direction of the cylinder"
                                                            : "the normal out of the rigid body") +
                          ", for example 0, 0, 1");
    }

    void check_self_contact(const Section &section, const ContactPairParameters &pair)
    {
      const std::string remove = "has no meaning with 'Self contact = true', where the slave faces touch each other; "
                                 "remove it, or take its faces to those of the slave side";
      RegionParameters  both   = pair.master; // of which the rigid bodies are master alone
      for (const unsigned int body : master_alone(pair).bodies)
        both.ids_of_body.erase(body);
      const bool has_slaves = std::all_of(pair.slave.bodies.begin(),
                                          pair.slave.bodies.end(),
                                          [&](const unsigned int body) { return pair.master.has_body(body); });
      for (const auto &[key, given] :
           {Given("Master body", pair.master.bodies.empty() || !has_slaves),
            Given("Master boundary ids",
                  both.boundary_ids != pair.slave.boundary_ids || both.ids_of_body != pair.slave.ids_of_body),
            Given("Master where", pair.master.where != pair.slave.where),
            Given("Master surface", pair.has_rigid_master())})
        section.require(!given, key, remove);
      section.require(pair.contact_law == ContactPairParameters::ContactLaw::unilateral,
                      "Contact law",
                      "is " + text_of(pair.contact_law) +
                          ", which a surface cannot be with itself; remove it, or give the pair a master");
    }

    void check_master(const Section &section, const ContactPairParameters &pair, const unsigned int n_bodies)
    {
      const auto &surface = pair.master_surface;
      if (pair.self_contact)
      {
        check_self_contact(section, pair);
        return;
      }
      if (!pair.has_rigid_master())
      {
        check(section, pair.master, "Master ", n_bodies, 1);
        section.require(pair.master.chooses_faces(),
                        "Master boundary ids",
                        "is missing; give the boundary ids or names of the faces in contact, or 'Where' they are");
        section.require(!share_faces(pair.slave, pair.master),
                        "Master boundary ids",
                        "names faces that are slaves of the same pair; give the two sides different bodies or ids");
        for (const auto &[key, given] : {Given("Master point", surface.point != Point()),
                                         Given("Master axis", surface.axis != Vector3()),
                                         Given("Master radius", surface.radius != 0.),
                                         Given("Master cavity", surface.cavity),
                                         Given("Master file", !surface.file.empty()),
                                         Given("Master scale", surface.scale != 1.),
                                         Given("Master translation", is_given(surface.motion))})
          section.require(
              !given,
              key,
              "and the like have no effect on a meshed master; remove them, or set Master surface to plane, "
              "sphere, cylinder, paraboloid or triangles");
        return;
      }
      const std::string shape = text_of(surface.shape);
      for (const auto &[key, given] :
           {Given("Master boundary ids", pair.master.has_ids()), Given("Master where", !pair.master.where.empty())})
        section.require(!given,
                        key,
                        "has no meaning besides 'Master surface = " + shape +
                            "', which has no mesh; remove one of the two");
      check_shape(section, surface, shape);
      section.require(pair.master.bodies.size() <= 1 && pair.master.first_body() <= n_bodies,
                      "Master body",
                      "is " + pair.master.body_numbers() + "; give the number of the rigid body that carries the " +
                          shape + ", 1 to " + std::to_string(n_bodies) + ", or 0 for none");
      section.require(!pair.has_carried_master() || !is_given(surface.motion),
                      "Master translation",
                      "and the like have no effect on a surface that moves with its Master body; remove them, or say "
                      "there how it moves");
      check(section, surface.motion, "Master ", surface.motion.rotation_axis == Vector3() ? surface.axis : Vector3());
    }

    /// With no more points than the degree rows of M (eq. W1) depend on each other, or are empty.
    void check_rule(const Section &section, const ContactPairParameters &pair, const unsigned int degree)
    {
      using Rule           = ContactPairParameters::QuadratureRule;
      const unsigned int n = pair.quadrature_points;
      section.require(n == 0 || pair.quadrature_rule != Rule::simpson || (n >= 3 && n % 2 == 1),
                      "Quadrature points",
                      "is " + std::to_string(n) + "; Simpson's rule takes an odd number from 3");
      section.require(n == 0 || pair.quadrature_rule != Rule::newton_cotes || (n >= 2 && n <= 5) || n == 7,
                      "Quadrature points",
                      "is " + std::to_string(n) + "; Newton-Cotes rules with positive weights have 2, 3, 4, 5 or 7");
      section.require(n == 0 || n > degree || pair.weights != ContactPairParameters::Weights::consistent,
                      "Quadrature points",
                      "is " + std::to_string(n) + "; consistent weights with 'Degree = " + std::to_string(degree) +
                          "' take " + std::to_string(degree + 1) + " or more");
    }

    void check_preload(const Section &section, const ContactPairParameters &pair)
    {
      for (const auto &[key, given] :
           {Given("Preload until", pair.preload.until != 0.), Given("Preload axis", pair.preload.axis != Vector3())})
        section.require(pair.is_section() || !given, key, "has no effect without a Preload; give that, or remove it");
      if (!pair.is_section())
        return;
      check_expression(section, "Preload", pair.preload.force, "t");
      section.require(pair.contact_law == ContactPairParameters::ContactLaw::tied,
                      "Preload",
                      "tightens a bolt whose two faces hold together; set 'Contact law = tied', or press a surface "
                      "with a boundary condition of 'Type = traction'");
      section.require(!pair.has_rigid_master(),
                      "Preload",
                      "needs the two faces of a cut through a bolt, not a Master surface; cut the mesh of the bolt in "
                      "two, and name the faces of both sides");
      section.require(pair.preload.until == 0. || pair.preload.until > pair.active_from,
                      "Preload until",
                      "is not after Active from; the bolt would never be tightened");
    }
  } // namespace

  void ParameterChecks::check(const Section               &section,
                              const ContactPairParameters &pair,
                              const unsigned int           n_bodies,
                              const unsigned int           degree)
  {
    check_friction(section, pair);
    check_gap_law(section, pair);
    const bool adjusts = pair.contact_law != ContactPairParameters::ContactLaw::unilateral ||
                         pair.start.overclosure == ContactPairParameters::InitialOverclosure::adjust;
    section.require(adjusts || pair.start.adjustment_distance == 0.,
                    "Adjustment distance",
                    "has no effect; set 'Initial overclosure = strain-free adjust', or remove it");
    check(section, pair.slave, "Slave ", n_bodies, 1);
    section.require(pair.slave.chooses_faces(),
                    "Slave boundary ids",
                    "is missing; give the boundary ids or names of the faces in contact, or 'Where' they are");
    section.require(
        pair.self_contact || (pair.excluded_bodies.empty() && pair.excluded_names.empty()),
        "Excluded bodies",
        "has no meaning without 'Self contact = true'; remove it, or leave the bodies out of the two sides");
    check_master(section, pair, n_bodies);

    using Scheme = ContactPairParameters::Scheme;
    section.require(pair.scheme == Scheme::nodal || pair.weights == ContactPairParameters::Weights::nodal_quadrature,
                    "Weights",
                    "is a choice of 'Scheme = nodal' alone; the other schemes bring their own weights: remove the key");
    check_rule(section, pair, degree);
    check_preload(section, pair);
  }
} // namespace Nodus
