#include "mesh/refinement.h"
#include "base/deal_ii_versions.h"

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/grid_refinement.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Cells whose squared error is this part of their share of the target are coarsened: eight of them make one with
    /// about that error.
    constexpr double coarsening_margin = 1. / 32.;

    /// To four digits or so: cells that are alike by symmetry stay alike on any number of ranks.
    double rounded(const double value)
    {
      constexpr double steps = 1e4;
      return value > 0. ? std::exp(std::round(std::log(value) * steps) / steps) : 0.;
    }

    double sum_over_owned(const Bodies::Triangulation &triangulation, const std::vector<double> &values)
    {
      double sum = 0.;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          sum += values[cell->active_cell_index()];
      return dealii::Utilities::MPI::sum(sum, communicator_of(triangulation));
    }
  } // namespace

  namespace
  {
    /// Takes back coarsening that cannot be: of a part of the eight, or beside cells that would be two levels finer. On
    /// the parts of the ranks deal.II would find less of it than on the whole mesh; here all see the same.
    void keep_possible_coarsening(Bodies::RefinableTriangulation &triangulation)
    {
      enum Flag : char
      {
        none,
        coarsen,
        refine
      };
      std::vector<char> flag(triangulation.n_active_cells(), none);
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          flag[cell->active_cell_index()] = cell->refine_flag_set()    ? refine
                                            : cell->coarsen_flag_set() ? coarsen
                                                                       : none;
      dealii::GridTools::exchange_cell_data_to_ghosts<char>(
          triangulation,
          [&](const auto &cell) { return flag[cell->active_cell_index()]; },
          [&](const auto &cell, const char value) { flag[cell->active_cell_index()] = value; });

      std::vector<int> level_at(triangulation.n_vertices(), 0); ///< the finest there will be without coarsening
      for (const auto &cell : triangulation.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            level_at[cell->vertex_index(v)] = std::max(
                level_at[cell->vertex_index(v)], cell->level() + (flag[cell->active_cell_index()] == refine ? 1 : 0));
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && cell->coarsen_flag_set())
        {
          bool       possible = cell->level() > 0;
          const auto parent   = possible ? cell->parent() : Bodies::Triangulation::cell_iterator(cell);
          for (unsigned int c = 0; possible && c < parent->n_children(); ++c)
          {
            const auto child = parent->child(c);
            possible = child->is_active() && !child->is_artificial() && flag[child->active_cell_index()] == coarsen;
            for (unsigned int v = 0; possible && v < dealii::GeometryInfo<dim>::vertices_per_cell; ++v)
              possible = level_at[child->vertex_index(v)] <= cell->level();
          }
          if (!possible)
            cell->clear_coarsen_flag();
        }
    }
  } // namespace

  double RefinementIndicator::relative_error(const Bodies::Triangulation &triangulation) const
  {
    return squared_norm > 0. ? std::sqrt(sum_over_owned(triangulation, squared_error) / squared_norm) : 0.;
  }

  bool mark_cells(const AdaptivityParameters        &parameters,
                  const std::vector<BodyParameters> &bodies,
                  const RefinementIndicator         &indicator,
                  const DoFIndex                     n_unknowns,
                  Bodies::RefinableTriangulation    &triangulation)
  {
    using Marking                       = AdaptivityParameters::Marking;
    namespace GridRefinement            = dealii::parallel::distributed::GridRefinement;
    const MPI_Comm         communicator = communicator_of(triangulation);
    const double           n_cells      = triangulation.n_global_active_cells();
    dealii::Vector<double> error(indicator.squared_error.size());
    std::transform(indicator.squared_error.begin(), indicator.squared_error.end(), error.begin(), rounded);
    const auto level_of = [&](const auto &cell)
    { return cell->level() - static_cast<int>(bodies[cell->material_id()].global_refinement); };
    const auto allowed = [&](const auto &cell)
    { return level_of(cell) < static_cast<int>(parameters.maximum_level) && bodies[cell->material_id()].has_mesh(); };

    if (sum_over_owned(triangulation, indicator.squared_error) > 0.)
    {
      if (parameters.marking == Marking::fixed_fraction)
        GridRefinement::refine_and_coarsen_fixed_fraction(
            triangulation, error, parameters.refine_fraction, parameters.coarsen_fraction);
      else
      {
        const double share  = parameters.target_error * parameters.target_error * indicator.squared_norm / n_cells;
        const bool   missed = indicator.relative_error(triangulation) > parameters.target_error;
        for (const auto &cell : triangulation.active_cell_iterators())
          if (const double here = error(cell->active_cell_index()); cell->is_locally_owned() && missed && here > share)
            cell->set_refine_flag();
          else if (cell->is_locally_owned() && here < coarsening_margin * share)
            cell->set_coarsen_flag();
      }
    }
    double n_refined = 0.;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        if (indicator.refine[cell->active_cell_index()])
        {
          cell->clear_coarsen_flag();
          cell->set_refine_flag();
        }
        if (!allowed(cell))
          cell->clear_refine_flag();
        if (level_of(cell) <= 0)
          cell->clear_coarsen_flag();
        n_refined += cell->refine_flag_set();
      }
    n_refined = dealii::Utilities::MPI::sum(n_refined, communicator);

    // A cell that is split adds seven; so do its unknowns, about.
    const double most = (parameters.maximum_unknowns / n_unknowns - 1.) * n_cells / 7.;
    if (n_refined > most)
    {
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && !cell->refine_flag_set())
          error(cell->active_cell_index()) = 0.;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          cell->clear_refine_flag();
      if (most >= 1.)
        GridRefinement::refine_and_coarsen_fixed_number(triangulation, error, most / n_cells, 0.);
    }

    keep_possible_coarsening(triangulation);
    triangulation.prepare_coarsening_and_refinement();
    unsigned int changes = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      changes += cell->is_locally_owned() && (cell->refine_flag_set() || cell->coarsen_flag_set());
    return dealii::Utilities::MPI::max(changes, communicator) > 0;
  }
} // namespace Nodus
