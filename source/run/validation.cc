#include "run/validation.h"
#include "base/deal_ii_versions.h"
#include "mesh/sides.h"
#include "parameters/physical_names.h"
#include "run/unheld_bodies.h"
#include "solve/linear_solver.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <tuple>

namespace Nodus
{
  namespace
  {
    using Type = BoundaryConditionParameters::Type;

    /// Gaps up to this part of a face are printed as 0.
    constexpr double round_off = 1e-12;
    /// Means of gaps that differ from those of the nodes by more than this part of a face are explained.
    constexpr double seen_bulge = 1e-4;

    std::string counted(const unsigned int n, const std::string &what)
    {
      return std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
    }

    template <typename List>
    std::string joined(const List &list, const std::string &separator)
    {
      std::ostringstream text;
      for (const auto &item : list)
        text << (text.tellp() > 0 ? separator : "") << item;
      return text.str();
    }

    /// The part of the mesh that a boundary condition acts on.
    struct Extent
    {
      unsigned int nodes = 0, faces = 0, cells = 0;
      std::string  point;        ///< that it acts at
      double       measure = 0.; ///< area of the faces or volume of the cells, reference configuration
    };

    /// Displacements act on nodes, and on the faces all of whose nodes they take; loads on faces or, body forces, on
    /// cells. Collective.
    Extent extent_of(const BoundaryConditionParameters &condition,
                     const Bodies                      &bodies,
                     const dealii::DoFHandler<dim>     &dof_handler,
                     const dealii::Mapping<dim>        &mapping)
    {
      const auto               &fe      = dof_handler.get_fe();
      const auto               &scalar  = fe.base_element(0);
      const bool                on_cell = condition.type == Type::body_force;
      const Region              region(condition.region, bodies, condition.name, on_cell);
      dealii::FEValues<dim>     cell_values(mapping, fe, dealii::QGauss<dim>(fe.degree + 1), dealii::update_JxW_values);
      dealii::FEFaceValues<dim> face_values(
          mapping, fe, dealii::QGauss<dim - 1>(fe.degree + 1), dealii::update_JxW_values);
      std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
      std::set<DoFIndex>    nodes; ///< first degrees of freedom, owned
      Extent                extent;

      // Nodes of own cells' neighbours may be own ones, too: ghost cells count for nodes.
      const auto take_nodes = [&](const auto &cell, const unsigned int face)
      {
        bool          all    = true;
        const Vector3 normal = region.normal(mapping, cell, face);
        cell->get_dof_indices(dofs);
        for (unsigned int a = 0; a < scalar.n_dofs_per_cell(); ++a)
          if (scalar.has_support_on_face(a, face))
          {
            const DoFIndex dof = dofs[fe.component_to_system_index(0, a)];
            if (!region.contains_point(mapping.transform_unit_to_real_cell(cell, scalar.unit_support_point(a)), normal))
              all = false;
            else if (dof_handler.locally_owned_dofs().is_element(dof))
              nodes.insert(dof);
          }
        return all;
      };
      for (const auto &cell : dof_handler.active_cell_iterators())
      {
        if (cell->is_artificial())
          continue;
        if (on_cell && cell->is_locally_owned() && region.selects_cell(mapping, cell))
        {
          ++extent.cells;
          cell_values.reinit(cell);
          for (const auto q : cell_values.quadrature_point_indices())
            extent.measure += cell_values.JxW(q);
        }
        for (const auto face : cell->face_indices())
          if (!on_cell && region.contains_face(cell, face))
          {
            const bool takes = condition.holds() ? take_nodes(cell, face) : region.selects_face(mapping, cell, face);
            if (!takes || !cell->is_locally_owned())
              continue;
            ++extent.faces;
            face_values.reinit(cell, face);
            for (const auto q : face_values.quadrature_point_indices())
              extent.measure += face_values.JxW(q);
          }
      }
      extent.nodes                = nodes.size();
      const MPI_Comm communicator = communicator_of(dof_handler);
      for (unsigned int *n : {&extent.nodes, &extent.faces, &extent.cells})
        *n = dealii::Utilities::MPI::sum(*n, communicator);
      extent.measure = dealii::Utilities::MPI::sum(extent.measure, communicator);
      return extent;
    }

    std::string describe(const BoundaryConditionParameters &condition, const Extent &extent)
    {
      std::ostringstream text;
      text << text_of(condition.type);
      for (unsigned int c = 0; c < condition.components.size(); ++c)
        text << (c == 0 ? " of " : ", ") << "xyz"[condition.components[c]];
      if (!condition.direction.empty())
        text << " along " << coordinates(Point(condition.directions().front()));
      text << (condition.at_point() ? " at " : " on ") << extent.point;
      if (condition.type == Type::body_force)
        text << counted(extent.cells, "cell") << ", volume " << extent.measure;
      else if (!condition.at_point())
      {
        if (condition.holds())
          text << counted(extent.nodes, "node") << " and ";
        text << counted(extent.faces, "face") << ", area " << extent.measure;
      }
      if (condition.type == Type::rigid_motion)
        text << ", translation " << joined(condition.motion.translation, "; ") << ", rotation "
             << condition.motion.rotation;
      else
        text << ", value " << joined(condition.value, "; ");
      for (const unsigned int c : condition.free)
        text << (c == condition.free.front() ? ", free to " : ", ") << (c < dim ? "move along " : "turn about ")
             << "xyz"[c % dim];
      return text.str();
    }

    std::string describe(const ContactPairParameters &pair)
    {
      using Scheme = ContactPairParameters::Scheme;
      std::ostringstream text;
      text << text_of(pair.scheme) << " scheme"
           << (pair.scheme == Scheme::averaged ? ", by " + text_of(pair.applied_integration()) : "") << ", "
           << text_of(pair.surface) << " surface, ";
      using Pair = ContactPairParameters;
      if (pair.contact_law != Pair::ContactLaw::unilateral)
        text << text_of(pair.contact_law) << ", ";
      if (pair.contact_law == Pair::ContactLaw::tied)
        text << "no slip";
      else if (pair.friction_law == Pair::FrictionLaw::tresca)
        text << "Tresca friction " << pair.shear_limit;
      else if (pair.friction_law == Pair::FrictionLaw::own)
        text << "friction law " << pair.own_friction_law.name;
      else if (pair.friction_coefficient > 0.)
      {
        text << "friction coefficient " << pair.friction_coefficient;
        if (pair.second_friction_coefficient > 0.)
          text << " and " << pair.second_friction_coefficient << " across";
        if (pair.shear_limit > 0.)
          text << ", at most " << pair.shear_limit;
      }
      else
        text << "no friction";
      if (pair.friction_factor != "1")
        text << ", times " << pair.friction_factor;
      if (pair.elastic_slip > 0.)
        text << " over an elastic slip of " << pair.elastic_slip;
      if (pair.pressure_gap.law != PressureGapParameters::Law::hard)
        text << ", "
             << (pair.pressure_gap.law == PressureGapParameters::Law::own ? pair.pressure_gap.own_law.name
                                                                          : text_of(pair.pressure_gap.law))
             << " pressure-gap law";
      return text.str();
    }

    std::string describe(const LoadSteppingParameters &path)
    {
      std::ostringstream text;
      text << "t = 0";
      for (unsigned int i = 0; i < path.increments.size(); ++i)
        text << (i == 0 ? " to " : ", to ") << path.interval_ends[i] << " in "
             << counted(path.increments[i], "increment");
      return text.str();
    }

    /// Slave sites of one pair before anything has moved.
    struct Gaps
    {
      unsigned int sites = 0, found = 0, closed = 0, adjusted = 0;
      double       smallest = std::numeric_limits<double>::max(), largest = -std::numeric_limits<double>::max();
      double       smallest_at_nodes = smallest, largest_at_nodes = largest; ///< of averaged jumps: of the nodes alone
    };

    /// The bodies and the sides that conditions can be set on. Collective.
    void describe_bodies(const Model &model, Console &console)
    {
      std::vector<unsigned int> cells(model.bodies.size());
      for (const auto &cell : model.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          ++cells[cell->material_id()];
      dealii::Utilities::MPI::sum(cells, model.communicator, cells);
      const auto sides = sides_of(model.bodies, model.dof_handler, *model.mapping);
      for (unsigned int b = 0; b < model.bodies.size(); ++b)
      {
        const BodyParameters &body     = model.parameters.bodies[b];
        const auto           &material = body.material;
        const auto            ends     = model.bodies.bounding_box(b).get_boundary_points();
        const Vector3         size     = ends.second - ends.first;
        std::ostringstream    text;
        text << "  body " << b + 1 << " (" << model.bodies.name(b) << "): ";
        if (model.bodies.has_mesh(b))
          text << counted(cells[b], "cell") << ", " << size[0] << " x " << size[1] << " x " << size[2] << " from "
               << coordinates(without_round_off(ends.first, size.norm())) << " to "
               << coordinates(without_round_off(ends.second, size.norm())) << ", boundary ids "
               << joined(model.bodies.boundary_ids(b), ", ") << "; ";
        else
          text << "no mesh; ";
        if (body.rigid)
        {
          text << "rigid";
          for (const unsigned int c : body.rigid_free)
            text << (c == body.rigid_free.front() ? ", free to " : ", ") << (c < dim ? "move along " : "turn about ")
                 << "xyz"[c % dim];
        }
        else
          text << text_of(material.law) << ", E = " << material.youngs_modulus << ", nu = " << material.poissons_ratio;
        console.line(text.str());
        for (const auto &[id, side] : sides[b])
          console.line("    boundary id " + named_id(id, model.bodies.boundary_names(b)) + ": " + side.text());
      }
    }

    /// What each boundary condition takes hold of. Collective.
    void describe_conditions(const Model &model, Console &console)
    {
      auto load = model.boundary_conditions->loads().begin(); // in the order of the conditions
      for (unsigned int n = 0; n < model.parameters.boundary_conditions.size(); ++n)
      {
        const auto &condition = model.parameters.boundary_conditions[n];
        Extent      extent;
        if (condition.at_point())
          extent.point = coordinates(load->point()) + " of body " + std::to_string(load->place->body + 1) +
                         in_brackets(model.bodies.name(load->place->body));
        else
          extent = extent_of(condition, model.bodies, model.dof_handler, *model.mapping);
        console.line("  boundary condition " + std::to_string(n + 1) + in_brackets(condition.name) + ": " +
                     describe(condition, extent));
        load += !condition.holds();
      }
    }

    /// Gaps of a pair after the first pairing, on all ranks; @p lost: own sites without a master point. Collective.
    Gaps gaps_of(const Model &model, const unsigned int pair, std::vector<unsigned int> &lost)
    {
      const ContactInterface &contact  = *model.contact;
      const ContactSurfaces  &surfaces = contact.surfaces();
      const Pairing          &pairing  = contact.pairing();
      const Status           &status   = contact.status();
      const bool averages = model.parameters.contact_pairs[pair].scheme == ContactPairParameters::Scheme::averaged;
      Gaps       gaps;
      for (unsigned int k = 0; k < pairing.size(); ++k)
        if (surfaces.pair(k) == pair && surfaces.has_status(k) && surfaces.is_owned(k))
        {
          ++gaps.sites;
          gaps.closed += status.contact(k);
          if (!pairing[k].found)
          {
            lost.push_back(k);
            continue;
          }
          ++gaps.found;
          const double distance = contact.distance(k) + status.adjustment(k);
          gaps.adjusted += status.adjustment(k) != 0.;
          const double gap = std::abs(distance) < round_off * surfaces.face_size(pair) ? 0. : -distance;
          gaps.smallest    = std::min(gaps.smallest, gap);
          gaps.largest     = std::max(gaps.largest, gap);
          if (const Projection &master = pairing[k].master; averages && master.found())
          {
            const ContactGeometry &geometry = *contact.geometry();
            const double at_node = pairing[k].normal * (geometry.master[pair].at(master.face, master.xi, master.eta).x -
                                                        geometry.position(surfaces, k)) -
                                   status.adjustment(k);
            gaps.smallest_at_nodes = std::min(gaps.smallest_at_nodes, at_node);
            gaps.largest_at_nodes  = std::max(gaps.largest_at_nodes, at_node);
          }
        }
      for (unsigned int *count : {&gaps.sites, &gaps.found, &gaps.closed, &gaps.adjusted})
        *count = dealii::Utilities::MPI::sum(*count, model.communicator);
      for (double *value : {&gaps.smallest, &gaps.smallest_at_nodes})
        *value = dealii::Utilities::MPI::min(*value, model.communicator);
      for (double *value : {&gaps.largest, &gaps.largest_at_nodes})
        *value = dealii::Utilities::MPI::max(*value, model.communicator);
      return gaps;
    }

    /// What the averaged scheme makes of gaps between curved surfaces.
    void describe_bulge(Gaps gaps, const double size, Console &console)
    {
      if (gaps.smallest_at_nodes > gaps.largest_at_nodes ||
          std::max(std::abs(gaps.smallest - gaps.smallest_at_nodes), std::abs(gaps.largest - gaps.largest_at_nodes)) <=
              seen_bulge * size)
        return;
      std::ostringstream bulge;
      for (double *value : {&gaps.smallest_at_nodes, &gaps.largest_at_nodes})
        *value = std::abs(*value) < round_off * size ? 0. : *value;
      bulge << "    of the nodes themselves " << gaps.smallest_at_nodes << " to " << gaps.largest_at_nodes
            << "; contact acts on means around them, which touching faces of length h and relative radius R lower by "
               "h^2/(12 R) in each direction";
      console.line(bulge.str());
    }

    void describe_pair(const Model &model, const unsigned int pair, Console &console)
    {
      const ContactSurfaces       &surfaces   = model.contact->surfaces();
      const ContactPairParameters &parameters = model.parameters.contact_pairs[pair];
      const std::string            name       = "  contact pair " + std::to_string(pair + 1);
      std::ostringstream           text;
      if (parameters.active_from > 0.)
      {
        text << name << ": " << describe(parameters) << ", acts after t = " << parameters.active_from;
        return console.line(text.str());
      }
      std::vector<unsigned int> lost;
      const Gaps                gaps = gaps_of(model, pair, lost);
      text << name << ": " << gaps.found << " of " << gaps.sites
           << (surfaces.has_points(pair) ? " integration points" : " slave nodes") << " find a master point";
      if (gaps.found > 0)
        text << ", gap " << gaps.smallest << " to " << gaps.largest << ", " << gaps.closed << " start closed";
      else
        text << "; are the boundary ids right, and is 'Search distance' large enough?";
      if (gaps.adjusted > 0)
        text << ", " << gaps.adjusted << " adjusted";
      console.line(name + ": " + describe(parameters));
      console.line(text.str());
      describe_bulge(gaps, surfaces.face_size(pair), console);
      for (const auto &[side, region, is_mesh] :
           {std::make_tuple("slave", &parameters.slave, true),
            std::make_tuple("master", &parameters.master, !parameters.has_rigid_master())})
        if (is_mesh && is_one_face_wide(Region(*region, model.bodies, name), model.dof_handler, *model.mapping))
          console.line(name + ": the " + side +
                       " surface is one face wide; have more across it, unless the problem is a plane one");
      if (const auto loci = model.contact->loci(lost, 3); !loci.empty())
        console.line(name + ": no master point for " + joined(loci, "; ") +
                     (gaps.sites - gaps.found > loci.size() ? "; ..." : ""));
    }

    /// Motions that nothing holds as @p increment begins. Collective.
    void describe_free_motions(const Model &model, const State &state, const Increment &increment, Console &console)
    {
      std::string free;
      bool        may_wait = true; // friction may come to turn rigid bodies
      for (const auto &motion : free_motions(model, state, increment.end))
      {
        free += (free.empty() ? "" : "; ") + motion.text;
        for (unsigned int b = 0; b < model.bodies.size(); ++b)
          may_wait = may_wait && (model.parameters.bodies[b].rigid || motion.moves[b] == std::array<bool, dim>{});
      }
      if (free.empty())
        return;
      const std::string holds =
          model.stabilisation->acts() ? "viscous stabilisation does"
          : may_wait
              ? "contact or its friction has to"
              : ways_to_hold(model, state, increment, "hold them with boundary conditions (soft springs will do)");
      console.line(std::string(may_wait ? "  " : "  warning: ") +
                   "nothing holds these motions as the run begins: " + free + "; " + holds);
    }
  } // namespace

  void validate(Model &model, States &states, const Increment &first, Console &console)
  {
    describe_bodies(model, console);
    describe_conditions(model, console);
    const std::vector<std::string> warnings = model.begin_contact(states, 0.);
    for (unsigned int pair = 0; pair < model.contact->surfaces().n_pairs(); ++pair)
      describe_pair(model, pair, console);
    for (const std::string &sentence : warnings)
      console.line("  warning: " + sentence);
    model.contact->residual().jump.resize(model.contact->surfaces().n_sites()); // nothing rubs yet
    model.impose(first);
    describe_free_motions(model, states.now, first, console);
    const Parameters &p = model.parameters;
    console.line("  loops: geometry " + text_of(p.geometry_loop.mode) + ", threshold " +
                 text_of(p.threshold_loop.mode) + ", status " + text_of(p.status_loop.mode));
    const std::string solver = solver_choice(p, model.dof_handler.n_dofs()).text();
    console.line("  linear solver: " + solver +
                 (solver == text_of(p.linear_solver.type) ? "" : " (" + text_of(p.linear_solver.type) + ")"));
    console.line("  load path: " + describe(p.load_stepping));
    console.line("  results: " + p.output.results_folder);
  }
} // namespace Nodus
