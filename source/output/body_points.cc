#include "output/body_points.h"
#include "base/deal_ii_versions.h"
#include "mesh/point_location.h"
#include "mesh/sides.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    using Cell = DoFHandler<dim>::active_cell_iterator;

    /// Why @p place is refused. Collective.
    std::string outside(const Bodies            &bodies,
                        const DoFHandler<dim>   &dof_handler,
                        const Mapping<dim>      &mapping,
                        const BodyPoints::Place &place)
    {
      std::vector<double> distances(bodies.size(), std::numeric_limits<double>::max());
      for (const Cell &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned() && bodies.has_mesh(cell->material_id()))
        {
          double &nearest = distances[cell->material_id()];
          nearest         = std::min(nearest, distance_to(mapping, cell, place.X));
        }
      Utilities::MPI::min(distances, communicator_of(dof_handler.get_triangulation()), distances);
      const unsigned int nearest = std::min_element(distances.begin(), distances.end()) - distances.begin();
      std::ostringstream text;
      text << place.what << " at " << coordinates(place.X) << " is outside of body " << place.body << " ("
           << bodies.name(place.body - 1) << ")";
      if (nearest + 1 == place.body)
        text << ", at a distance of " << distances[nearest];
      else
        text << "; the nearest body is " << nearest + 1 << " (" << bodies.name(nearest) << "), at a distance of "
             << (distances[nearest] < point_round_off * distances[place.body - 1] ? 0. : distances[nearest]);
      return text.str();
    }
  } // namespace

  BodyPoints::BodyPoints(const Bodies             &bodies,
                         const DoFHandler<dim>    &dof_handler,
                         const Mapping<dim>       &mapping,
                         const std::vector<Place> &places)
      : communicator_(communicator_of(bodies.triangulation()))
      , shares_(places.size())
  {
    const auto                       &fe   = dof_handler.get_fe();
    const unsigned int                rank = Utilities::MPI::this_mpi_process(communicator_);
    std::vector<Cell>                 cells(places.size());
    std::vector<std::optional<Point>> found(places.size());
    for (const Cell &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (unsigned int i = 0; i < places.size(); ++i)
          if (!found[i] && cell->material_id() + 1 == places[i].body)
            if (const auto p = unit_point_in(mapping, cell, places[i].X))
            {
              cells[i] = cell;
              found[i] = p;
            }

    std::vector<unsigned int> holder(places.size()); // of several ranks the first
    for (unsigned int i = 0; i < places.size(); ++i)
      holder[i] = found[i] ? rank : std::numeric_limits<unsigned int>::max();
    Utilities::MPI::min(holder, communicator_, holder);

    std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
    for (unsigned int i = 0; i < places.size(); ++i)
    {
      if (holder[i] == std::numeric_limits<unsigned int>::max())
        throw InputError(outside(bodies, dof_handler, mapping, places[i]));
      if (holder[i] != rank)
        continue;
      cells[i]->get_dof_indices(dofs);
      for (unsigned int j = 0; j < dofs.size(); ++j)
        if (fe.system_to_component_index(j).first == 0)
          shares_[i].emplace_back(dofs[j], fe.shape_value(j, *found[i]));
    }
  }

  std::vector<BodyPoints::Values> BodyPoints::values(const Vector &u, const NodalStress &stress) const
  {
    constexpr unsigned int n_numbers = dim + SymmetricTensor<2, dim>::n_independent_components;
    std::vector<double>    numbers(n_numbers * shares_.size(), 0.);
    for (unsigned int i = 0; i < shares_.size(); ++i)
      for (const auto &[dof, share] : shares_[i])
      {
        const SymmetricTensor<2, dim> sigma = stress.stress(dof);
        for (unsigned int n = 0; n < n_numbers; ++n)
          numbers[n_numbers * i + n] += share * (n < dim ? u(dof + n) : sigma.access_raw_entry(n - dim));
      }
    Utilities::MPI::sum(numbers, communicator_, numbers);
    std::vector<Values> all(shares_.size());
    for (unsigned int i = 0; i < all.size(); ++i)
      for (unsigned int n = 0; n < n_numbers; ++n)
        (n < dim ? all[i].displacement[n] : all[i].cauchy_stress.access_raw_entry(n - dim)) =
            numbers[n_numbers * i + n];
    return all;
  }
} // namespace Nodus
