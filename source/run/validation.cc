#include "mesh/sides.h"
#include "run/contact_problem_implementation.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <tuple>

// What --validate says about a case: bodies, what each condition takes hold of, gaps, loops, load path.

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
      const Region              region(condition.region, bodies, condition.name);
      dealii::FEValues<dim>     cell_values(mapping, fe, dealii::QGauss<dim>(fe.degree + 1), dealii::update_JxW_values);
      dealii::FEFaceValues<dim> face_values(
          mapping, fe, dealii::QGauss<dim - 1>(fe.degree + 1), dealii::update_JxW_values);
      std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
      std::set<DoFIndex>    nodes; ///< first degrees of freedom, owned
      Extent                extent;

      // Nodes of own cells' neighbours may be own ones, too: ghost cells count for nodes.
      const auto take_nodes = [&](const auto &cell, const unsigned int face)
      {
        bool all = true;
        cell->get_dof_indices(dofs);
        for (unsigned int a = 0; a < scalar.n_dofs_per_cell(); ++a)
          if (scalar.has_support_on_face(a, face))
          {
            const DoFIndex dof = dofs[fe.component_to_system_index(0, a)];
            if (!region.contains_point(mapping.transform_unit_to_real_cell(cell, scalar.unit_support_point(a))))
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
            const bool takes = condition.type == Type::displacement ? take_nodes(cell, face)
                                                                    : region.selects_face(mapping, cell, face);
            if (!takes || !cell->is_locally_owned())
              continue;
            ++extent.faces;
            face_values.reinit(cell, face);
            for (const auto q : face_values.quadrature_point_indices())
              extent.measure += face_values.JxW(q);
          }
      }
      extent.nodes                = nodes.size();
      const MPI_Comm communicator = dof_handler.get_communicator();
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
      text << " on ";
      if (condition.type == Type::body_force)
        text << counted(extent.cells, "cell") << ", volume " << extent.measure;
      else
      {
        if (condition.type == Type::displacement)
          text << counted(extent.nodes, "node") << " and ";
        text << counted(extent.faces, "face") << ", area " << extent.measure;
      }
      text << ", value " << joined(condition.value, "; ");
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
  } // namespace

  void ContactProblem::validate()
  {
    auto       &p            = *implementation_;
    const auto &parameters   = p.parameters;
    const auto  communicator = p.communicator;
    p.summary();

    std::vector<unsigned int> cells(p.bodies.size());
    for (const auto &cell : p.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        ++cells[cell->material_id()];
    dealii::Utilities::MPI::sum(cells, communicator, cells);
    const auto sides = sides_of(p.bodies, p.dof_handler, *p.mapping);
    for (unsigned int b = 0; b < p.bodies.size(); ++b)
    {
      const auto        &material = parameters.bodies[b].material;
      const auto         ends     = p.bodies.bounding_box(b).get_boundary_points();
      const Vector3      size     = ends.second - ends.first;
      std::ostringstream text;
      text << "  body " << b + 1 << " (" << p.bodies.name(b) << "): ";
      if (p.bodies.has_mesh(b))
        text << counted(cells[b], "cell") << ", " << size[0] << " x " << size[1] << " x " << size[2] << " from "
             << coordinates(without_round_off(ends.first, size.norm())) << " to "
             << coordinates(without_round_off(ends.second, size.norm())) << ", boundary ids "
             << joined(p.bodies.boundary_ids(b), ", ") << "; ";
      else
        text << "no mesh; ";
      if (parameters.bodies[b].rigid)
      {
        text << "rigid";
        for (const unsigned int c : parameters.bodies[b].rigid_free)
          text << (c == parameters.bodies[b].rigid_free.front() ? ", free to " : ", ")
               << (c < dim ? "move along " : "turn about ") << "xyz"[c % dim];
      }
      else
        text << text_of(material.law) << ", E = " << material.youngs_modulus << ", nu = " << material.poissons_ratio;
      p.console.line(text.str());
      for (const auto &[id, side] : sides[b])
        p.console.line("    boundary id " + std::to_string(id) + ": " + side.text());
    }

    for (unsigned int n = 0; n < parameters.boundary_conditions.size(); ++n)
    {
      const auto &condition = parameters.boundary_conditions[n];
      p.console.line("  boundary condition " + std::to_string(n + 1) + in_brackets(condition.name) + ": " +
                     describe(condition, extent_of(condition, p.bodies, p.dof_handler, *p.mapping)));
    }

    p.pair_surfaces();
    for (unsigned int pair = 0; pair < p.surfaces->n_pairs(); ++pair)
    {
      Gaps                      gaps;
      std::vector<unsigned int> lost;
      for (unsigned int k = 0; k < p.pairing.size(); ++k)
        if (p.surfaces->pair(k) == pair && p.surfaces->has_status(k) && p.surfaces->is_owned(k))
        {
          ++gaps.sites;
          gaps.closed += p.status->contact(k);
          if (!p.pairing[k].found)
          {
            lost.push_back(k);
            continue;
          }
          ++gaps.found;
          const double distance = p.contact->distance(p.state, k) + p.status->adjustment(k);
          gaps.adjusted += p.status->adjustment(k) != 0.;
          const double gap = std::abs(distance) < round_off * p.surfaces->face_size(pair) ? 0. : -distance;
          gaps.smallest    = std::min(gaps.smallest, gap);
          gaps.largest     = std::max(gaps.largest, gap);
          if (const Projection &master = p.pairing[k].master;
              parameters.contact_pairs[pair].scheme == ContactPairParameters::Scheme::averaged && master.found())
          {
            const double at_node =
                p.pairing[k].normal * (p.geometry->master[pair].at(master.face, master.xi, master.eta).x -
                                       p.geometry->position(*p.surfaces, k)) -
                p.status->adjustment(k);
            gaps.smallest_at_nodes = std::min(gaps.smallest_at_nodes, at_node);
            gaps.largest_at_nodes  = std::max(gaps.largest_at_nodes, at_node);
          }
        }
      for (unsigned int *count : {&gaps.sites, &gaps.found, &gaps.closed, &gaps.adjusted})
        *count = dealii::Utilities::MPI::sum(*count, communicator);
      for (double *value : {&gaps.smallest, &gaps.smallest_at_nodes})
        *value = dealii::Utilities::MPI::min(*value, communicator);
      for (double *value : {&gaps.largest, &gaps.largest_at_nodes})
        *value = dealii::Utilities::MPI::max(*value, communicator);

      const std::string  name = "  contact pair " + std::to_string(pair + 1);
      std::ostringstream text;
      text << name << ": " << gaps.found << " of " << gaps.sites
           << (p.surfaces->has_points(pair) ? " integration points" : " slave nodes") << " find a master point";
      const double size = p.surfaces->face_size(pair);
      if (gaps.found > 0)
        text << ", gap " << gaps.smallest << " to " << gaps.largest << ", " << gaps.closed << " start closed";
      else
        text << "; are the boundary ids right, and is 'Search distance' large enough?";
      if (gaps.adjusted > 0)
        text << ", " << gaps.adjusted << " adjusted";
      p.console.line(name + ": " + describe(parameters.contact_pairs[pair]));
      p.console.line(text.str());
      if (gaps.smallest_at_nodes <= gaps.largest_at_nodes &&
          std::max(std::abs(gaps.smallest - gaps.smallest_at_nodes), std::abs(gaps.largest - gaps.largest_at_nodes)) >
              seen_bulge * size)
      {
        std::ostringstream bulge;
        for (double *value : {&gaps.smallest_at_nodes, &gaps.largest_at_nodes})
          *value = std::abs(*value) < round_off * size ? 0. : *value;
        bulge << "    of the nodes themselves " << gaps.smallest_at_nodes << " to " << gaps.largest_at_nodes
              << "; contact acts on means around them, which touching faces of length h and relative radius R lower by "
                 "h^2/(12 R) in each direction";
        p.console.line(bulge.str());
      }
      for (const auto &[side, region, is_mesh] :
           {std::make_tuple("slave", &parameters.contact_pairs[pair].slave, true),
            std::make_tuple(
                "master", &parameters.contact_pairs[pair].master, !parameters.contact_pairs[pair].has_rigid_master())})
        if (is_mesh && is_one_face_wide(Region(*region, p.bodies, name), p.dof_handler, *p.mapping))
          p.console.line(name + ": the " + side +
                         " surface is one face wide; have more across it, unless the problem is a plane one");
      if (const auto loci = p.site_loci(lost, 3); !loci.empty())
        p.console.line(name + ": no master point for " + joined(loci, "; ") +
                       (gaps.sites - gaps.found > loci.size() ? "; ..." : ""));
    }

    p.residual.jump.resize(p.surfaces->n_sites()); // nothing rubs yet
    p.impose(p.path.target());
    std::string free;
    bool        may_wait = true; // friction may come to turn rigid bodies
    for (const auto &motion : p.free_motions(OwnedNodes(p.dof_handler, *p.mapping)))
    {
      free += (free.empty() ? "" : "; ") + motion.text;
      for (unsigned int b = 0; b < p.bodies.size(); ++b)
        may_wait = may_wait && (parameters.bodies[b].rigid || motion.moves[b] == std::array<bool, dim>{});
    }
    if (!free.empty())
      p.console.line(std::string(may_wait ? "  " : "  warning: ") +
                     "nothing holds these motions as the run begins: " + free + "; " +
                     (p.stabilisation->acts() ? "viscous stabilisation does"
                      : may_wait              ? "contact or its friction has to"
                                 : p.ways_to_hold("hold them with boundary conditions (soft springs will do)")));

    p.console.line("  loops: geometry " + text_of(parameters.geometry_loop.mode) + ", threshold " +
                   text_of(parameters.threshold_loop.mode) + ", status " + text_of(parameters.status_loop.mode));
    const auto solver = chosen_solver(parameters, p.dof_handler.n_dofs());
    p.console.line(
        "  linear solver: " + text_of(solver) +
        (solver == parameters.linear_solver.type ? "" : " (" + text_of(parameters.linear_solver.type) + ")"));
    p.console.line("  load path: " + describe(parameters.load_stepping));
    p.console.line("  results: " + parameters.output.results_folder);
  }
} // namespace Nodus
