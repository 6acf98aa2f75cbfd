#include "parameters/expression.h"
#include "parameters/general_contact.h"
#include "parameters/parameter_checks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <sstream>

// What a single value cannot tell: fixes are part of every message, file and line are added by ParameterFile.

namespace Nodus
{
  namespace
  {
    /// deal.II ends with an exception of its own where p4est can go no deeper; with this many levels it still works.
    constexpr unsigned int deepest_level = 17;

    using ParameterChecks::check;
    using ParameterChecks::check_expression;
    using ParameterChecks::Given;
    using ParameterChecks::is_given;
    using ParameterChecks::refuse_material;
    using ParameterChecks::Section;
    using ParameterChecks::share_faces;

    void check(const Section &section, const BodyParameters &body)
    {
      section.require(body.has_mesh() || body.rigid, "Mesh file", "is missing; give either Mesh file or Generator");
      section.require(body.mesh_file.empty() || body.generator.empty(),
                      "Generator",
                      "is given besides Mesh file; remove one of the two");
      if (!body.has_mesh())
        for (const auto &[key, given] : {Given("Generator arguments", !body.generator_arguments.empty()),
                                         Given("Scale", body.scale != 1.),
                                         Given("Rotation angle", body.rotation_angle != 0.),
                                         Given("Translation", body.translation != Vector3()),
                                         Given("Global refinement", body.global_refinement > 0),
                                         Given("Local refinement", body.local_refinement > 0)})
          section.require(
              !given, key, "has no effect on a rigid body without a mesh; remove it, or give Mesh file or Generator");
      if (!body.mesh_file.empty())
      {
        std::error_code unknown;
        section.require(std::filesystem::is_regular_file(body.mesh_file, unknown),
                        "Mesh file",
                        "is no file: " + body.mesh_file + "; names are relative to the folder of the .prm file");
        section.require(body.generator_arguments.empty(), "Generator arguments", "goes with Generator only; remove it");
      }
      else
        section.require(
            body.volume_ids.empty() && body.volume_names.empty(), "Volume ids", "goes with Mesh file only; remove it");
      section.require(body.rotation_angle == 0. || body.rotation_axis.norm() > 0.,
                      "Rotation axis",
                      "must not be zero when there is a Rotation angle; give a direction such as 0, 0, 1");
      section.require((body.local_refinement > 0) == !body.refine_where.empty(),
                      "Refine where",
                      "and Local refinement go together; give both or none");
      section.require(std::uint64_t(body.global_refinement) + body.local_refinement <= deepest_level,
                      body.local_refinement > 0 ? "Local refinement" : "Global refinement",
                      "goes deeper than the " + std::to_string(deepest_level) +
                          " levels that a mesh can have; refine less, or begin with more cells");
      if (!body.refine_where.empty())
        check_expression(section, "Refine where", body.refine_where, "x,y,z");
      if (!body.rigid)
      {
        section.require(!is_given(body.motion),
                        "Rigid translation",
                        "and the like have no effect on a body that is not rigid; remove them, or set 'Rigid = true'");
        const BodyParameters none;
        section.require(body.rigid_free.empty() && body.rigid_force == none.rigid_force &&
                            body.rigid_moment == none.rigid_moment,
                        "Rigid free",
                        "and Rigid force and moment have no effect on a body that is not rigid; remove them, or set "
                        "'Rigid = true'");
        check({section.file, section.name + "/Material"}, body.material);
        return;
      }
      check(section, body.motion, "Rigid ", Vector3());
      ParameterChecks::check_free_motion(
          section, "Rigid ", body.motion, body.rigid_free, body.rigid_force, body.rigid_moment);
      section.require(body.volumetric_treatment == BodyParameters::VolumetricTreatment::standard,
                      "Volumetric treatment",
                      "has no effect on a rigid body; remove it");
      refuse_material({section.file, section.name + "/Material"}, body.material);
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
      const std::size_t n_given = load.viscous_stabilisation.size();
      section.require(n_given == 1 || n_given == load.interval_ends.size(),
                      "Viscous stabilisation",
                      "has " + std::to_string(n_given) + " entries for " + std::to_string(load.interval_ends.size()) +
                          " entries of Interval ends; give one for all intervals, or one for each");
      for (unsigned int i = 0; i < load.increments.size(); ++i)
        section.require(load.stabilisation(i) == 0. || load.increments[i] > 1,
                        "Viscous stabilisation",
                        "is gone at the end of an interval; give every interval that has it 2 Increments at least");
      section.require(load.maximum_increment == 0. || load.minimum_increment <= load.maximum_increment,
                      "Minimum increment",
                      "is larger than Maximum increment; lower it");
    }

    /// What time alone can be given for.
    void check_arc_length(const ParameterFile &file, const Parameters &p)
    {
      using Overclosure                  = ContactPairParameters::InitialOverclosure;
      const LoadSteppingParameters &load = p.load_stepping;
      const Section                 section{file, "Load stepping"};
      section.require(load.control.size() == 1 || load.control.size() == load.interval_ends.size(),
                      "Control",
                      "has " + std::to_string(load.control.size()) + " entries for " +
                          std::to_string(load.interval_ends.size()) +
                          " entries of Interval ends; give one for all intervals, or one for each");
      if (!load.has_arc_length())
        return;
      section.require(!load.is_stabilised(),
                      "Viscous stabilisation",
                      "resists motions in time, which goes back under 'Control = arc length'; remove it, and hold the "
                      "bodies by conditions or springs that are 'Active until' the end of an interval before");
      Section{file, "Adaptivity"}.require(p.adaptivity.interval == 0 && p.adaptivity.repetitions == 0,
                                          p.adaptivity.interval > 0 ? "Interval" : "Repetitions",
                                          "and 'Load stepping/Control = arc length' do not go together: what has not "
                                          "been in equilibrium on a mesh has no branch there; refine with 'Initial "
                                          "cycles' or the bodies' refinement instead");
      for (unsigned int i = 0; i < p.contact_pairs.size(); ++i)
      {
        const Section                pair{file, "Contact pair " + std::to_string(i + 1)};
        const ContactPairParameters &parameters = p.contact_pairs[i];
        pair.require(!is_given(parameters.master_surface.motion),
                     "Master translation",
                     "or rotation moves a surface at given times, which arc length cannot find; let a rigid body carry "
                     "the surface, with 'Master body', 'Rigid translation' or 'Rigid free' and 'Rigid force'");
        pair.require(
            expression_complaint(parameters.friction_factor, "x,y,z,v").empty(),
            "Friction factor",
            "depends on the time, which arc length is to find; take t out of it, or set 'Load stepping/Control "
            "= time'");
        pair.require(!parameters.is_section(),
                     "Preload",
                     "is a force at given times, until a given time, which arc length cannot find; set 'Load stepping/"
                     "Control = time'");
        const auto first =
            std::upper_bound(load.interval_ends.begin(), load.interval_ends.end(), parameters.active_from);
        pair.require(parameters.start.overclosure != Overclosure::interference ||
                         !load.has_arc_length(first - load.interval_ends.begin()),
                     "Initial overclosure",
                     "is pressed out in the course of the first interval that the pair acts in, which must have 'Load "
                     "stepping/Control = time': put one before, 'Control = time, arc length'");
      }
    }

    /// What a preload has to do with the load path and the loops.
    void check_preload(const Section &section, const ContactPairParameters &pair, const Parameters &p)
    {
      const std::vector<double> &ends = p.load_stepping.interval_ends;
      section.require(pair.preload.until == 0. || std::count(ends.begin(), ends.end(), pair.preload.until) > 0,
                      "Preload until",
                      "must be 0 or one of the times in Load stepping / Interval ends; add it there");
      section.require(!pair.is_section() || p.geometry_loop.mode != LoopParameters::Mode::once,
                      "Preload",
                      "moves the two faces past each other, which 'Geometry loop/Mode = once' does not follow; remove "
                      "that");
    }

    /// @p level: of the finest cells of any body before.
    void check(const Section &section, const AdaptivityParameters &adaptivity, const std::uint64_t level)
    {
      section.require((adaptivity.interval == 0 && adaptivity.repetitions == 0) ||
                          level + adaptivity.maximum_level <= deepest_level,
                      "Maximum level",
                      "goes deeper than the " + std::to_string(deepest_level) +
                          " levels that a mesh can have, together with the refinement of the bodies; lower it");
      section.require(adaptivity.refine_fraction + adaptivity.coarsen_fraction <= 1.,
                      "Coarsen fraction",
                      "and Refine fraction together are more than 1; no cell can be in both");
      if (adaptivity.indicator == AdaptivityParameters::Indicator::own)
        for (const std::string &key : section.file.keys(section.name))
          section.require(key != "Bulk weight" && key != "Contact weight",
                          key,
                          "has no effect on the indicator '" + adaptivity.own_indicator.name + "'; remove it");
      section.require(adaptivity.bulk_weight + adaptivity.contact_weight > 0. || adaptivity.interval == 0,
                      "Bulk weight",
                      "and Contact weight are both 0: there is no indicator; give one of them");
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

    void check_output(const ParameterFile &file, const Parameters &p)
    {
      const auto check_body = [&](const Section &section, const unsigned int body)
      {
        section.require(1 <= body && body <= p.bodies.size(),
                        "Body",
                        "is " + std::to_string(body) + ", but there are " + std::to_string(p.bodies.size()) +
                            " bodies; give the number of one of them");
        section.require(p.bodies[body - 1].has_mesh(), "Body", "has no mesh; give the number of a body that has one");
      };
      for (unsigned int i = 0; i < p.output_points.size(); ++i)
        check_body({file, "Output point " + std::to_string(i + 1)}, p.output_points[i].body);
      for (unsigned int i = 0; i < p.output_lines.size(); ++i)
      {
        const Section section{file, "Output line " + std::to_string(i + 1)};
        check_body(section, p.output_lines[i].body);
        section.require(p.output_lines[i].from != p.output_lines[i].to, "To", "is where From is; give the other end");
      }
      check_names(file, "Output point", p.output_points);
      check_names(file, "Output line", p.output_lines);
    }

    /// The bodies of a pair: with meshes, and one side to give way.
    void
    check_bodies(const Section &section, const ContactPairParameters &pair, const std::vector<BodyParameters> &bodies)
    {
      const auto some = [&](const RegionParameters &side, const auto &is)
      {
        return std::any_of(
            side.bodies.begin(), side.bodies.end(), [&](const unsigned int b) { return is(bodies[b - 1]); });
      };
      const auto rigid    = [](const BodyParameters &body) { return body.rigid; };
      const auto meshless = [](const BodyParameters &body) { return !body.has_mesh(); };
      section.require(!some(pair.slave, meshless), "Slave body", "has no mesh; give the number of a body that has one");
      section.require(pair.has_rigid_master() || !some(pair.master, meshless),
                      "Master body",
                      "has no mesh; say what surface it carries with Master surface, or give it a mesh");
      section.require(!pair.has_carried_master() || some(pair.master, rigid),
                      "Master body",
                      "is not rigid and cannot carry a rigid surface; remove it, or set 'Rigid = true' there");
      if (pair.self_contact)
      {
        const RegionParameters alone = master_alone(pair);
        section.require(!some(pair.slave, rigid),
                        "Slave body",
                        "has rigid bodies alone, which do not touch each other; name one that can give way");
        section.require(
            std::all_of(
                alone.bodies.begin(), alone.bodies.end(), [&](const unsigned int b) { return rigid(bodies[b - 1]); }),
            "Master body",
            "has a body that is not on the slave side, of 'Self contact = true'; remove it, or name it there");
      }
      section.require(!some(pair.slave, rigid) || !(pair.has_rigid_master() || some(pair.master, rigid)),
                      "Slave body",
                      "is rigid, as is the master: neither can give way; remove the pair");
      section.require(!pair.is_section() || !(some(pair.slave, rigid) || some(pair.master, rigid)),
                      "Preload",
                      "is given, but a body of the pair is rigid; put the cut through a part of the bolt that deforms");
    }
  } // namespace

  void Parameters::check(const ParameterFile &file) const
  {
    const unsigned int n_bodies = bodies.size();
    if (n_bodies == 0)
      throw InputError(this->file + ": there is no body; add a subsection 'Body 1'");

    for (unsigned int i = 0; i < n_bodies; ++i)
      Nodus::check({file, "Body " + std::to_string(i + 1)}, bodies[i]);
    Section{file, "Body 1"}.require(
        std::any_of(bodies.begin(), bodies.end(), [](const BodyParameters &body) { return !body.rigid; }),
        "Rigid",
        "is true for all bodies; there is nothing to solve, leave one deformable");
    for (unsigned int i = 0; i < boundary_conditions.size(); ++i)
    {
      const Section section{file, "Boundary condition " + std::to_string(i + 1)};
      Nodus::check(section, boundary_conditions[i], n_bodies, load_stepping.interval_ends);
      for (unsigned int b = 0; b < n_bodies; ++b)
        section.require(bodies[b].has_mesh() || !boundary_conditions[i].region.has_body(b + 1) ||
                            (boundary_conditions[i].region.bodies.empty() &&
                             boundary_conditions[i].type != BoundaryConditionParameters::Type::body_force),
                        "Body",
                        "is or includes body " + std::to_string(b + 1) +
                            ", which has no mesh; leave it out, and drive it by Rigid translation or Rigid force");
    }
    for (unsigned int i = 0; i < contact_pairs.size(); ++i)
    {
      const Section section{file, "Contact pair " + std::to_string(i + 1)};
      Nodus::check(section, contact_pairs[i], n_bodies, degree);
      ParameterChecks::check(section, contact_pairs[i], "pair", load_stepping.interval_ends);
      const ContactPairParameters &pair = contact_pairs[i];
      check_bodies(section, pair, bodies);
      check_preload(section, pair, *this);
      for (unsigned int j = 0; j < i; ++j)
        section.require(pair.self_contact || contact_pairs[j].self_contact ||
                            !share_faces(contact_pairs[i].slave, contact_pairs[j].slave),
                        "Slave boundary ids",
                        "names faces that are already slaves of 'Contact pair " + std::to_string(j + 1) +
                            "'; a face can be slave only once, of a master that may have several bodies");
    }
    for (unsigned int b = 0; b < n_bodies; ++b)
      Section{file, "Body " + std::to_string(b + 1)}.require(
          bodies[b].has_mesh() ||
              std::any_of(contact_pairs.begin(),
                          contact_pairs.end(),
                          [b](const ContactPairParameters &pair) { return pair.master.first_body() == b + 1; }),
          "Mesh file",
          "is missing, and the body carries no surface either; give a mesh, or a contact pair with a Master surface "
          "and 'Master body = " +
              std::to_string(b + 1) + "'");
    check_names(file, "Body", bodies);
    check_names(file, "Boundary condition", boundary_conditions);
    check_names(file, "Contact pair", contact_pairs);
    check_output(file, *this);

    Nodus::check({file, "Linear solver"}, linear_solver);
    Nodus::check({file, "Load stepping"}, load_stepping);
    check_arc_length(file, *this);
    std::uint64_t level = 0;
    for (const BodyParameters &body : bodies)
      level = std::max(level, std::uint64_t(body.global_refinement) + body.local_refinement);
    Nodus::check({file, "Adaptivity"}, adaptivity, level);
  }
} // namespace Nodus
