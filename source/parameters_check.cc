#include <nodus/mesh/expression.h>
#include <nodus/parameter_file.h>
#include <nodus/parameters.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include <set>
#include <sstream>

// What a single value cannot tell: fixes are part of every message, file and line are added by ParameterFile.

namespace Nodus
{
  namespace
  {
    /// A subsection under inspection.
    struct Section
    {
      const ParameterFile &file;
      std::string          name;

      void require(const bool satisfied, const std::string &key, const std::string &message) const
      {
        if (!satisfied)
          file.refuse(name, key, message);
      }
    };

    /// @p variables: "x,y,z", and perhaps a fourth one, or "t" alone.
    void check_expression(const Section     &section,
                          const std::string &key,
                          const std::string &text,
                          const std::string &variables)
    {
      const std::string problem = expression_complaint(text, variables);
      section.require(problem.empty(),
                      key,
                      "has the expression '" + text + "' that does not parse: " + problem +
                          (variables == "t" ? "; the variable is t"
                                            : "; variables are x, y, z" +
                                                  (variables.size() > 5 ? std::string(", ") + variables.back() : "")) +
                          ", constants pi");
    }

    void check_ogden(const Section &section, const MaterialParameters &material)
    {
      const auto &moduli = material.ogden_moduli, &exponents = material.ogden_exponents;
      section.require(!moduli.empty(), "Ogden moduli", "is missing; give one number for each term");
      section.require(exponents.size() == moduli.size(),
                      "Ogden exponents",
                      "has " + std::to_string(exponents.size()) + " entries for " + std::to_string(moduli.size()) +
                          " entries of Ogden moduli; give one for each term");
      section.require(std::count(exponents.begin(), exponents.end(), 0.) == 0,
                      "Ogden exponents",
                      "must not be 0; remove such a term");
      section.require(
          std::inner_product(moduli.begin(), moduli.end(), exponents.begin(), 0.) > 0.,
          "Ogden moduli",
          "times the exponents give a shear modulus that is not > 0; a modulus has the sign of its exponent");
    }

    void check_hardening(const Section &section, const MaterialParameters &material)
    {
      const auto &strains = material.hardening_strains, &stresses = material.hardening_stresses;
      if (!strains.empty() || !stresses.empty())
      {
        section.require(material.yield_stress == 0. && material.hardening_modulus == 0. &&
                            material.saturation_stress == 0. && material.saturation_rate == 0.,
                        "Hardening strains",
                        "is a table besides Yield stress, Hardening modulus or Saturation; remove one of the two");
        section.require(strains.size() == stresses.size(),
                        "Hardening stresses",
                        "has " + std::to_string(stresses.size()) + " entries for " + std::to_string(strains.size()) +
                            " entries of Hardening strains; give one for each");
        section.require(strains[0] == 0. &&
                            std::adjacent_find(strains.begin(), strains.end(), std::greater_equal<>()) == strains.end(),
                        "Hardening strains",
                        "must begin with 0 and increase");
        section.require(stresses[0] > 0. &&
                            std::adjacent_find(stresses.begin(), stresses.end(), std::greater<>()) == stresses.end(),
                        "Hardening stresses",
                        "must be > 0 and must not decrease; softening would depend on the mesh");
        return;
      }
      section.require(material.yield_stress > 0., "Yield stress", "must be given and > 0, or a hardening table");
      section.require((material.saturation_stress > 0.) == (material.saturation_rate > 0.),
                      "Saturation stress",
                      "and Saturation rate go together; give both or none");
      section.require(material.saturation_stress == 0. || material.saturation_stress >= material.yield_stress,
                      "Saturation stress",
                      "must not be below Yield stress; softening would depend on the mesh");
    }

    void check(const Section &section, const MaterialParameters &material)
    {
      using Law = MaterialParameters::Law;
      section.require(
          material.poissons_ratio > -1. && material.poissons_ratio < 0.5,
          "Poisson's ratio",
          "must be > -1 and < 0.5; for nearly incompressible material take 0.499 and 'Volumetric treatment = "
          "mean dilatation'");
      section.require(material.mooney_rivlin_ratio == 0. || material.law == MaterialParameters::Law::mooney_rivlin,
                      "Mooney-Rivlin ratio",
                      "has no effect on this law; remove it or set Law = Mooney-Rivlin");
      if (material.law == Law::ogden)
      {
        section.require(material.youngs_modulus == 0.,
                        "Young's modulus",
                        "follows from the moduli and exponents of Ogden; remove it");
        check_ogden(section, material);
      }
      else
      {
        section.require(material.youngs_modulus > 0., "Young's modulus", "must be given and > 0");
        for (const auto &[key, values] : {std::make_pair("Ogden moduli", &material.ogden_moduli),
                                          std::make_pair("Ogden exponents", &material.ogden_exponents)})
          section.require(values->empty(), key, "has no effect on this law; remove it or set Law = Ogden");
      }
      if (material.law == Law::j2_plasticity)
        check_hardening(section, material);
      else
        for (const auto &[key, given] : {std::make_pair("Yield stress", material.yield_stress != 0.),
                                         std::make_pair("Hardening modulus", material.hardening_modulus != 0.),
                                         std::make_pair("Saturation stress", material.saturation_stress != 0.),
                                         std::make_pair("Saturation rate", material.saturation_rate != 0.),
                                         std::make_pair("Hardening strains", !material.hardening_strains.empty()),
                                         std::make_pair("Hardening stresses", !material.hardening_stresses.empty())})
          section.require(!given, key, "has no effect on this law; remove it or set Law = J2 plasticity");
    }

    void check(const Section &section, const BodyParameters &body)
    {
      section.require(!body.mesh_file.empty() || !body.generator.empty(),
                      "Mesh file",
                      "is missing; give either Mesh file or Generator");
      section.require(body.mesh_file.empty() || body.generator.empty(),
                      "Generator",
                      "is given besides Mesh file; remove one of the two");
      if (!body.mesh_file.empty())
      {
        section.require(std::filesystem::is_regular_file(body.mesh_file),
                        "Mesh file",
                        "is no file: " + body.mesh_file + "; names are relative to the folder of the .prm file");
        section.require(body.generator_arguments.empty(), "Generator arguments", "goes with Generator only; remove it");
      }
      else
        section.require(body.volume_ids.empty(), "Volume ids", "goes with Mesh file only; remove it");
      section.require(body.rotation_angle == 0. || body.rotation_axis.norm() > 0.,
                      "Rotation axis",
                      "must not be zero when there is a Rotation angle; give a direction such as 0, 0, 1");
      check({section.file, section.name + "/Material"}, body.material);
    }

    void check(const Section          &section,
               const RegionParameters &region,
               const std::string      &prefix,
               const unsigned int      n_bodies,
               const unsigned int      smallest_body)
    {
      const std::string choice = (smallest_body == 0 ? "0 (every body) to " : "1 to ") + std::to_string(n_bodies);
      section.require(region.body >= smallest_body && region.body <= n_bodies,
                      prefixed(prefix, "Body"),
                      "is " + std::to_string(region.body) + "; give the number of a body, " + choice);
      if (!region.where.empty())
        check_expression(section, prefixed(prefix, "Where"), region.where, "x,y,z");
    }

    void check(const Section                     &section,
               const BoundaryConditionParameters &condition,
               const unsigned int                 n_bodies,
               const std::vector<double>         &interval_ends)
    {
      using Type = BoundaryConditionParameters::Type;
      check(section, condition.region, "", n_bodies, 0);
      const bool on_boundary = condition.type != Type::body_force;
      section.require(condition.region.boundary_ids.empty() != on_boundary,
                      "Boundary ids",
                      on_boundary ? "is missing; give the ids of the faces the condition acts on"
                                  : "has no meaning for a body force; remove it");

      const bool directed = condition.type != Type::pressure;
      section.require(condition.components.empty() != directed,
                      "Components",
                      directed ? "is missing; give some of x, y, z"
                               : "has no meaning for a pressure, which acts along the normal; remove it");
      const std::set<unsigned int> distinct(condition.components.begin(), condition.components.end());
      section.require(distinct.size() == condition.components.size(),
                      "Components",
                      "names a direction twice; give each of x, y, z at most once");

      const std::size_t wanted = directed ? condition.components.size() : 1;
      section.require(condition.value.size() == wanted,
                      "Value",
                      condition.value.empty()
                          ? "is missing; give an expression of x, y, z, t such as 0 or -0.1*t"
                          : "has " + std::to_string(condition.value.size()) + " expressions for " +
                                std::to_string(wanted) + (directed ? " components" : " pressure") +
                                "; separate expressions by ';', one for each component or one for all");
      for (const auto &expression : condition.value)
      {
        section.require(!expression.empty(), "Value", "has an empty expression; write 0 for zero");
        check_expression(section, "Value", expression, "x,y,z,t");
      }

      for (const auto &[key, t] : {std::pair<const char *, double>("Active from", condition.active_from),
                                   {"Active until", condition.active_until}})
        section.require(t == 0. || std::count(interval_ends.begin(), interval_ends.end(), t) > 0,
                        key,
                        "must be 0 or one of the times in Load stepping / Interval ends; add it there");
      section.require(condition.active_until == 0. || condition.active_until > condition.active_from,
                      "Active until",
                      "is not after Active from; the condition would never act");
    }

    bool share_faces(const RegionParameters &a, const RegionParameters &b)
    {
      const auto in_b = [&b](const dealii::types::boundary_id id)
      { return std::count(b.boundary_ids.begin(), b.boundary_ids.end(), id) > 0; };
      // Different predicates may separate faces of one id; the mesh will tell.
      return a.body == b.body && a.where == b.where && std::any_of(a.boundary_ids.begin(), a.boundary_ids.end(), in_b);
    }

    void check_friction(const Section &section, const ContactPairParameters &pair)
    {
      const bool tied    = pair.contact_law == ContactPairParameters::ContactLaw::tied,
                 coulomb = pair.friction_coefficient > 0.;
      for (const auto &[key, given] :
           {std::make_pair("Friction coefficient", coulomb),
            std::make_pair("Shear limit", pair.shear_limit > 0.),
            std::make_pair("Initial overclosure",
                           pair.initial_overclosure != ContactPairParameters::InitialOverclosure::resolve)})
        section.require(!tied || !given, key, "has no effect on a tied pair; remove it");
      section.require(pair.contact_law == ContactPairParameters::ContactLaw::unilateral ||
                          pair.initial_overclosure == ContactPairParameters::InitialOverclosure::resolve,
                      "Initial overclosure",
                      "has no effect on a bilateral pair, which is always adjusted; remove it");
      section.require(!tied || pair.initial_status != ContactPairParameters::InitialStatus::open,
                      "Initial status",
                      "is open, but a tied pair never closes later; remove it");
      if (pair.friction_law == ContactPairParameters::FrictionLaw::tresca)
      {
        section.require(!tied, "Friction law", "has no effect on a tied pair; remove it");
        section.require(pair.shear_limit > 0., "Shear limit", "must be given and > 0: it is the friction of Tresca");
        section.require(!coulomb, "Friction coefficient", "has no effect on 'Friction law = Tresca'; remove it");
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
      const bool factor = pair.friction_factor != "1";
      section.require(!factor || coulomb || pair.friction_law == ContactPairParameters::FrictionLaw::tresca,
                      "Friction factor",
                      "has no effect without friction; give a Friction coefficient");
      if (factor)
        check_expression(section, "Friction factor", pair.friction_factor, "x,y,z,v");
    }

    /// @p axis: about which the motion turns where it names none.
    void check(const Section                    &section,
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

    bool is_given(const PrescribedMotionParameters &motion)
    {
      const PrescribedMotionParameters none;
      return motion.translation != none.translation || motion.rotation != none.rotation ||
             motion.rotation_axis != none.rotation_axis || !motion.rotation_centre.empty();
    }

    void check_master(const Section &section, const ContactPairParameters &pair, const unsigned int n_bodies)
    {
      using Shape         = MasterSurfaceParameters::Shape;
      const auto &surface = pair.master_surface;
      if (!pair.has_rigid_master())
      {
        check(section, pair.master, "Master ", n_bodies, 1);
        section.require(!pair.master.boundary_ids.empty(),
                        "Master boundary ids",
                        "is missing; give the boundary ids of the faces in contact");
        section.require(!share_faces(pair.slave, pair.master),
                        "Master boundary ids",
                        "names faces that are slaves of the same pair; give the two sides different bodies or ids");
        for (const auto &[key, given] : {std::make_pair("Master point", surface.point != Point()),
                                         std::make_pair("Master axis", surface.axis != Vector3()),
                                         std::make_pair("Master radius", surface.radius != 0.),
                                         std::make_pair("Master cavity", surface.cavity),
                                         std::make_pair("Master translation", is_given(surface.motion))})
          section.require(
              !given,
              key,
              "and the like have no effect on a meshed master; remove them, or set Master surface to plane, "
              "sphere, cylinder or paraboloid");
        return;
      }
      const std::string shape = text_of(surface.shape);
      for (const auto &[key, given] : {std::make_pair("Master body", pair.master.body != 0),
                                       std::make_pair("Master boundary ids", !pair.master.boundary_ids.empty()),
                                       std::make_pair("Master where", !pair.master.where.empty())})
        section.require(!given,
                        key,
                        "has no meaning besides 'Master surface = " + shape +
                            "', which has no mesh; remove one of the two");
      const bool plane = surface.shape == Shape::plane, sphere = surface.shape == Shape::sphere;
      section.require(plane || surface.radius > 0., "Master radius", "must be given and > 0 for a " + shape);
      section.require(!plane || surface.radius == 0., "Master radius", "has no meaning for a plane; remove it");
      section.require(
          !plane || !surface.cavity,
          "Master cavity",
          "has no meaning for a plane; remove it, the body is on the side that Master axis points away from");
      section.require(sphere || surface.axis.norm() > 0.,
                      "Master axis",
                      std::string("must be given and not zero: ") +
                          (surface.shape == Shape::cylinder ? "the direction of the cylinder"
                                                            : "the normal out of the rigid body") +
                          ", for example 0, 0, 1");
      check(section, surface.motion, "Master ", surface.motion.rotation_axis == Vector3() ? surface.axis : Vector3());
    }

    void check(const Section &section, const ContactPairParameters &pair, const unsigned int n_bodies)
    {
      check_friction(section, pair);
      const bool adjusts = pair.contact_law != ContactPairParameters::ContactLaw::unilateral ||
                           pair.initial_overclosure == ContactPairParameters::InitialOverclosure::adjust;
      section.require(adjusts || pair.adjustment_distance == 0.,
                      "Adjustment distance",
                      "has no effect; set 'Initial overclosure = strain-free adjust', or remove it");
      check(section, pair.slave, "Slave ", n_bodies, 1);
      section.require(!pair.slave.boundary_ids.empty(),
                      "Slave boundary ids",
                      "is missing; give the boundary ids of the faces in contact");
      check_master(section, pair, n_bodies);

      using Scheme = ContactPairParameters::Scheme;
      using Rule   = ContactPairParameters::QuadratureRule;
      section.require(
          pair.scheme == Scheme::nodal || pair.weights != ContactPairParameters::Weights::consistent,
          "Weights",
          "is consistent, which needs 'Scheme = nodal'; the other schemes bring their own weights: remove the key");
      const unsigned int n = pair.quadrature_points;
      section.require(n == 0 || pair.quadrature_rule != Rule::simpson || (n >= 3 && n % 2 == 1),
                      "Quadrature points",
                      "is " + std::to_string(n) + "; Simpson's rule takes an odd number from 3");
      section.require(n == 0 || pair.quadrature_rule != Rule::newton_cotes || (n >= 2 && n <= 5) || n == 7,
                      "Quadrature points",
                      "is " + std::to_string(n) + "; Newton-Cotes rules with positive weights have 2, 3, 4, 5 or 7");
    }

    void check(const Section &section, const LinearSolverParameters &solver)
    {
      section.require(solver.tolerance < 1., "Tolerance", "must be < 1; it is relative, for example 1e-10");
    }

    void check(const Section &section, const LoadSteppingParameters &load)
    {
      double begin = 0.;
      for (const double end : load.interval_ends)
      {
        std::ostringstream message;
        message << "goes from " << begin << " to " << end << "; the times must increase and be > 0";
        section.require(end > begin, "Interval ends", message.str());
        begin = end;
      }
      section.require(load.increments.size() == load.interval_ends.size(),
                      "Increments",
                      "has " + std::to_string(load.increments.size()) + " entries for " +
                          std::to_string(load.interval_ends.size()) +
                          " entries of Interval ends; give one number for each interval");
      section.require(load.viscous_stabilisation == 0. ||
                          *std::min_element(load.increments.begin(), load.increments.end()) > 1,
                      "Viscous stabilisation",
                      "is gone at the end of an interval; give every interval 2 Increments at least");
      section.require(load.maximum_increment == 0. || load.minimum_increment <= load.maximum_increment,
                      "Minimum increment",
                      "is larger than Maximum increment; lower it");
    }

    template <typename Struct>
    void check_names(const ParameterFile &file, const std::string &subsection, const std::vector<Struct> &all)
    {
      for (unsigned int i = 0; i < all.size(); ++i)
        for (unsigned int j = 0; j < i; ++j)
          Section{file, subsection + ' ' + std::to_string(i + 1)}.require(
              all[i].name.empty() || all[i].name != all[j].name,
              "Name",
              "is also the name of '" + subsection + ' ' + std::to_string(j + 1) +
                  "'; tables could not tell them apart");
    }
  } // namespace

  void Parameters::check(const ParameterFile &file) const
  {
    const unsigned int n_bodies = bodies.size();
    if (n_bodies == 0)
      throw InputError(this->file + ": there is no body; add a subsection 'Body 1'");

    for (unsigned int i = 0; i < n_bodies; ++i)
      Nodus::check({file, "Body " + std::to_string(i + 1)}, bodies[i]);
    for (unsigned int i = 0; i < boundary_conditions.size(); ++i)
      Nodus::check({file, "Boundary condition " + std::to_string(i + 1)},
                   boundary_conditions[i],
                   n_bodies,
                   load_stepping.interval_ends);
    for (unsigned int i = 0; i < contact_pairs.size(); ++i)
    {
      const Section section{file, "Contact pair " + std::to_string(i + 1)};
      Nodus::check(section, contact_pairs[i], n_bodies);
      for (unsigned int j = 0; j < i; ++j)
        section.require(!share_faces(contact_pairs[i].slave, contact_pairs[j].slave),
                        "Slave boundary ids",
                        "names faces that are already slaves of 'Contact pair " + std::to_string(j + 1) +
                            "'; a face can be slave only once");
    }
    check_names(file, "Body", bodies);
    check_names(file, "Boundary condition", boundary_conditions);
    check_names(file, "Contact pair", contact_pairs);

    Nodus::check({file, "Linear solver"}, linear_solver);
    Nodus::check({file, "Load stepping"}, load_stepping);
  }
} // namespace Nodus
