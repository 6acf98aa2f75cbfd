#include "mesh/bodies.h"
#include "base/deal_ii_versions.h"
#include "mesh/memory.h"
#include "mesh/mesh_share.h"
#include "parallel/all_gather.h"
#include "parallel/throw_everywhere.h"
#include "parallel/wait_for_all.h"
#include "parameters/expression.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/manifold.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// The cell of each boundary face.
    std::vector<unsigned int> cells_at_boundary(const CoarseMesh &mesh)
    {
      // a cell has all vertices of its face: look among those of one vertex
      std::vector<std::vector<unsigned int>> cells(mesh.vertices.size());
      const auto                            &quads = mesh.boundary.boundary_quads;
      std::vector<char>                      is_first(mesh.vertices.size(), 0);
      for (const auto &quad : quads)
        is_first[quad.vertices[0]] = 1;
      for (unsigned int c = 0; c < mesh.cells.size(); ++c)
        for (const unsigned int v : mesh.cells[c].vertices)
          if (is_first[v])
            cells[v].push_back(c);
      std::vector<unsigned int> result;
      for (const auto &quad : quads)
        for (const unsigned int c : cells[quad.vertices[0]])
        {
          const auto &all = mesh.cells[c].vertices;
          if (std::all_of(quad.vertices.begin(),
                          quad.vertices.end(),
                          [&](const unsigned int v) { return std::find(all.begin(), all.end(), v) != all.end(); }))
          {
            result.push_back(c);
            break;
          }
        }
      return result;
    }

    /// The rank of each cell.
    std::vector<unsigned int>
    owners(const CoarseMesh &mesh, const std::vector<RegionParameters> &slaves, const unsigned int n_ranks)
    {
      std::vector<unsigned int>       slave_faces(mesh.cells.size(), 0);
      const auto                     &quads = mesh.boundary.boundary_quads;
      const std::vector<unsigned int> cell_of =
          n_ranks > 1 ? cells_at_boundary(mesh) : std::vector<unsigned int>(); // needed to divide alone
      for (unsigned int q = 0; q < cell_of.size(); ++q)
        for (const RegionParameters &slave : slaves)
          if (slave.takes(mesh.cells[cell_of[q]].material_id + 1, quads[q].boundary_id))
            ++slave_faces[cell_of[q]];
      return divide(mesh, slave_faces, Bodies::cell_weight, Bodies::slave_face_weight, n_ranks);
    }
  } // namespace

  Bodies::Bodies(const std::vector<BodyParameters>   &parameters,
                 const MPI_Comm                       communicator,
                 const bool                           may_be_refined,
                 const std::vector<RegionParameters> &slaves,
                 const unsigned int                   degree)
      : curved_(std::make_shared<CurvedGeometry>())
  {
    Manifolds        manifolds;
    const CoarseMesh mesh = read(parameters, degree, manifolds, communicator);
    // manifolds belong to lines and faces of all cells, and what carries a rigid body is looked for in all cells
    const bool refinable = may_be_refined || !manifolds.empty() ||
                           std::any_of(parameters.begin(),
                                       parameters.end(),
                                       [](const BodyParameters &body) {
                                         return body.rigid || body.global_refinement > 0 || body.local_refinement > 0;
                                       });
    if (refinable)
      make_refinable(mesh, manifolds, communicator);
    else
      make_share(mesh, slaves, communicator);
    refine(parameters, degree);
    collect_extents();
  }

  void Bodies::make_refinable(const CoarseMesh &mesh, const Manifolds &manifolds, const MPI_Comm communicator)
  {
    auto triangulation = std::make_unique<RefinableTriangulation>(communicator);
    refinable_         = triangulation.get();
    triangulation_     = std::move(triangulation);
    // merge_triangulations would lose the boundary ids and weld bodies that touch.
    triangulation_->create_triangulation(mesh.vertices, mesh.cells, mesh.boundary);
    for (const auto &[id, manifold] : manifolds)
      triangulation_->set_manifold(id, *manifold);
    if (!curved_->empty())
      triangulation_->signals.post_refinement.connect([this] { place_vertices(); });
  }

  void
  Bodies::make_share(const CoarseMesh &mesh, const std::vector<RegionParameters> &slaves, const MPI_Comm communicator)
  {
    const unsigned int        n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
    std::vector<unsigned int> owner(mesh.cells.size()); // one rank divides, the others sleep
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      owner = owners(mesh, slaves, n_ranks);
    wait_for_all(communicator);
    dealii::Utilities::MPI::broadcast(owner.data(), owner.size(), 0, communicator);
    if (std::set<unsigned int>(owner.begin(), owner.end()).size() < n_ranks)
      return make_refinable(mesh, {}, communicator); // p4est allows ranks without a cell
    triangulation_   = std::make_unique<dealii::parallel::fullydistributed::Triangulation<dim>>(communicator);
    const auto share = share_of(mesh, owner, no_boundary, communicator);
    triangulation_->create_triangulation(share);
    curved_->set_ids_are_numbers();
    const auto &held = share.coarse_cell_index_to_coarse_cell_id; // ascending
    curved_->keep([&held](const unsigned int cell) { return std::binary_search(held.begin(), held.end(), cell); });
  }

  /// Refinement puts new vertices on straight edges; they belong on the curved cell of the file. Every rank knows all
  /// coarse cells, so that nothing need be sent.
  void Bodies::place_vertices()
  {
    std::vector<Point> unit;
    for (const unsigned int v : dealii::GeometryInfo<dim>::vertex_indices())
      unit.push_back(dealii::GeometryInfo<dim>::unit_cell_vertex(v));
    for (const auto &cell : triangulation_->active_cell_iterators())
      if (cell->level() > 0 && curved_->covers(cell))
      {
        const auto x = curved_->positions(cell, unit);
        for (const unsigned int v : cell->vertex_indices())
          cell->vertex(v) = x[v];
      }
  }

  std::unique_ptr<dealii::Mapping<dim>> Bodies::make_mapping(const unsigned int degree) const
  {
    if (curved_->empty() || degree == 1) // the vertices of linear elements are in place
      return std::make_unique<dealii::MappingQ<dim>>(degree);
    return std::make_unique<CurvedMapping>(degree, curved_);
  }

  /// In the distributed triangulation, so that the coarse mesh stays small and p4est knows the hierarchy. Bodies share
  /// no face, so different levels of theirs make no hanging nodes.
  void Bodies::refine(const std::vector<BodyParameters> &parameters, const unsigned int degree)
  {
    unsigned int n_levels = 0;
    for (const auto &body : parameters)
      n_levels = std::max(n_levels, body.global_refinement + body.local_refinement);
    std::vector<std::unique_ptr<dealii::FunctionParser<dim>>> where;
    for (const auto &body : parameters)
      where.push_back(body.local_refinement > 0 ? parse_expression(body.refine_where) : nullptr);
    std::vector<unsigned int> n_local(parameters.size(), 0); // cells that are split locally
    const auto                complain = [&](const unsigned int b, const std::string &what)
    {
      return "Body " + std::to_string(b + 1) + " ('" + names_[b] + "'): 'Refine where' = '" +
             parameters[b].refine_where + "' " + what;
    };
    for (unsigned int level = 0; level < n_levels; ++level)
    {
      std::string problem;
      double      n_cells = 0.; // after this level
      for (const auto &cell : triangulation_->active_cell_iterators())
        if (cell->is_locally_owned())
        {
          const unsigned int    b    = cell->material_id();
          const BodyParameters &body = parameters[b];
          if (level < body.global_refinement)
            cell->set_refine_flag();
          else if (level < body.global_refinement + body.local_refinement)
          {
            const double value = where[b]->value(cell->center());
            if (!std::isfinite(value) && problem.empty())
            {
              std::ostringstream text;
              text << "is " << no_number(value) << " at (" << cell->center()
                   << "); write a condition that is true or false everywhere";
              problem = complain(b, text.str());
            }
            if (value != 0.)
            {
              cell->set_refine_flag();
              ++n_local[b];
            }
          }
          n_cells += cell->refine_flag_set() ? 8. : 1.;
        }
      throw_everywhere<InputError>(problem, communicator_of(*triangulation_));
      refuse_beyond_memory(dealii::Utilities::MPI::sum(n_cells, communicator_of(*triangulation_)),
                           degree,
                           communicator_of(*triangulation_));
      triangulation_->execute_coarsening_and_refinement();
    }
    dealii::Utilities::MPI::sum(n_local, communicator_of(*triangulation_), n_local);
    for (unsigned int b = 0; b < parameters.size(); ++b)
      if (parameters[b].local_refinement > 0 && n_local[b] == 0)
        throw InputError(
            complain(b, "holds at the centre of no cell; let it reach half a cell deeper, or drop 'Local refinement'"));
  }

  void Bodies::balance(const std::function<unsigned int(const Triangulation::cell_iterator &)> &weight)
  {
    if (!refinable_)
      return;
    refinable_->signals.weight.connect([weight](const Triangulation::cell_iterator &cell, const auto /*status*/)
                                       { return weight(cell); });
    refinable_->repartition();
  }

  void Bodies::collect_extents()
  {
    std::set<std::pair<unsigned int, dealii::types::boundary_id>> ids; // by body
    for (const auto &cell : triangulation_->active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() != no_boundary)
            ids.emplace(cell->material_id(), face->boundary_id());
    std::vector<unsigned int> own;
    for (const auto &[body, id] : ids)
      own.insert(own.end(), {body, id});
    boundary_ids_.resize(size());
    for (const auto &part : all_gather(communicator_of(*triangulation_), own))
      for (unsigned int i = 0; i < part.size(); i += 2)
        boundary_ids_[part[i]].insert(part[i + 1]);

    // Cells of second-order files are wider than their vertices tell.
    constexpr double         infinity = std::numeric_limits<double>::infinity();
    std::vector<double>      lower(dim * size(), infinity), upper(dim * size(), infinity); // upper: negative maxima
    const std::vector<Point> quadratic_nodes = dealii::FE_Q<dim>(2).get_unit_support_points();
    for (const auto &cell : triangulation_->active_cell_iterators())
      if (cell->is_locally_owned())
      {
        std::vector<Point> points;
        if (curved_->covers(cell))
          points = curved_->positions(cell, quadratic_nodes);
        for (const unsigned int v : cell->vertex_indices())
          points.push_back(cell->vertex(v));
        for (const Point &x : points)
          for (unsigned int d = 0; d < dim; ++d)
          {
            const auto i = dim * cell->material_id() + d;
            lower[i]     = std::min(lower[i], x[d]);
            upper[i]     = std::min(upper[i], -x[d]);
          }
      }
    dealii::Utilities::MPI::min(lower, communicator_of(*triangulation_), lower);
    dealii::Utilities::MPI::min(upper, communicator_of(*triangulation_), upper);
    for (unsigned int b = 0; b < size(); ++b)
    {
      Point low, high;
      for (unsigned int d = 0; d < dim; ++d)
      {
        low[d]  = lower[dim * b + d];
        high[d] = -upper[dim * b + d];
      }
      boxes_.emplace_back(std::make_pair(low, high));
    }
  }
} // namespace Nodus
