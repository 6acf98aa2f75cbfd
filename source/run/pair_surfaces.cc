#include "contact/site_values.h"
#include "parallel/wait_for_all.h"
#include "run/contact_problem_implementation.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

// Geometry passes: projections and frames at the current positions, and what they take over from those before.

namespace Nodus
{
  /// Projections, frames, jump operator and surface weights at the current positions.
  void ContactProblem::Implementation::freeze_geometry()
  {
    const auto              &pairs = parameters.contact_pairs;
    const std::vector<Point> X     = surfaces->positions(std::vector<Vector3>(surfaces->nodes().size()));
    paired_at                      = state.x;
    surfaces->place_carried_masters(paired_at);
    geometry = std::make_unique<ContactGeometry>(pairs, *surfaces, paired_at);
    averaged.compute(pairs, *surfaces, *geometry, paired_at, X);
    pairing.project(pairs, *surfaces, *geometry, averaged);
    jump.build(pairs, *surfaces, *geometry, pairing, averaged);
    weigh_surfaces();
    if (mesh_is_new)
      carry_over_sticking();
    wait_for_all(communicator);
  }

  /// Displacements of the surface nodes.
  std::vector<Vector3> ContactProblem::Implementation::surface_displacement() const
  {
    const std::vector<Point> X = surfaces->positions(std::vector<Vector3>(surfaces->nodes().size()));
    std::vector<Vector3>     u(X.size());
    for (unsigned int n = 0; n < u.size(); ++n)
      u[n] = state.x[n] - X[n];
    return u;
  }

  /// On a new mesh: sites that stick do so where the surfaces stuck, not where interpolated displacements that are not
  /// in equilibrium have put them: the jump of the displacement is taken over besides these. Where the difference would
  /// change friction by more than its limit it is one of geometry (slip on curved surfaces), and left out.
  void ContactProblem::Implementation::carry_over_sticking()
  {
    std::vector<Vector3> u = surface_displacement();
    for (unsigned int n = 0; n < u.size(); ++n)
      u[n] -= state.increment[n];
    std::vector<Vector3> stuck(surfaces->n_sites());
    for (unsigned int s = 0; s < stuck.size(); ++s)
    {
      if (!surfaces->is_owned(s) || !jump_known[s] || !pairing[s].found || !status->friction(s) || !status->stick(s))
        continue;
      Vector3 moved = jump.jump(s, u) - kept_jump[s];
      moved -= (moved * pairing[s].normal) * pairing[s].normal;
      if (status->tangential_augmentation(s, status->threshold(s)) * moved.norm() <= 1.)
        stuck[s] = moved;
    }
    surfaces->site_exchange().update(stuck);
    jump.set_stuck(std::move(stuck));
  }

  /// Freezes the geometry at the current positions and carries statuses and multipliers over.
  void ContactProblem::Implementation::pair_surfaces()
  {
    const auto    timer  = profile.time(Phase::pairing);
    const Pairing before = pairing;
    geometry.reset(); // it refers to the faces
    surfaces->fetch_masters(solution.block(0));
    gather_state();
    u_before_geometry = u_geometry;
    u_geometry        = solution.block(0);
    rigid_geometry    = rigid_bodies->unknowns();

    if (!paired_before)
    {
      // the first statuses are those before anything has moved, rigid masters included
      surfaces->move_rigid_masters(0., 0.);
      freeze_geometry();
      start_contact();
      paired_before     = true;
      committed_pairing = pairing;
      committed_area = nodal_area = weights.area();
      surfaces->move_rigid_masters(path.time(), time);
      if (surfaces->has_rigid_masters())
      {
        freeze_geometry();
        status->inherit(pairing);
      }
      return;
    }
    freeze_geometry();
    status->inherit(pairing);

    // Lambda keeps its direction in space and its length in the new tangent planes, lambda the nodal force; nodes
    // without partner lose all.
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
    {
      const DoFIndex multiplier = surfaces->multiplier(k);
      Vector3        Lambda;
      for (unsigned int i = 0; i < 2; ++i)
        Lambda += state.Lambda[k][i] * before[k].tangent[i];
      double component[2] = {0., 0.};
      for (unsigned int i = 0; i < 2; ++i)
        if (pairing[k].found && pairing[k].tangent_free[i])
          component[i] = Lambda * pairing[k].tangent[i];
      const double norm = std::hypot(component[0], component[1]);
      for (unsigned int i = 0; i < 2; ++i)
        solution.block(2)(2 * multiplier + i) = norm > 0. ? component[i] * Lambda.norm() / norm : 0.;
      const double ratio            = nodal_area.empty() ? 1. : nodal_area[k] / weights.area()[k]; // empty: new mesh
      solution.block(1)(multiplier) = pairing[k].found ? state.lambda[k] * ratio : 0.;
    }
    nodal_area = weights.area();
    solution.block(1).compress(dealii::VectorOperation::insert);
    solution.block(2).compress(dealii::VectorOperation::insert);
    gather_state();
  }

  void ContactProblem::Implementation::weigh_surfaces()
  {
    weights.compute(parameters.contact_pairs,
                    *surfaces,
                    averaged,
                    paired_at,
                    surfaces->positions(std::vector<Vector3>(surfaces->nodes().size())),
                    status->lumped());
  }

  /// Multipliers of lumped weights are the nodal means that those of consistent weights had.
  void ContactProblem::Implementation::pass_to_regularised_law()
  {
    const std::vector<double> mean   = site_pressure(*surfaces, weights, *status, state.lambda);
    const std::vector<bool>   lumped = status->lumped();
    weigh_surfaces();
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
      if (lumped[surfaces->pair(k)])
        solution.block(1)(surfaces->multiplier(k)) = mean[k];
    solution.block(1).compress(dealii::VectorOperation::insert);
    gather_state();
  }

  /// Statuses of the first pairing. @throws InputError on every rank where the bodies overlap too much.
  void ContactProblem::Implementation::start_contact()
  {
    std::vector<double>       distance;
    std::vector<double>       deepest(surfaces->n_pairs(), 0.);
    std::vector<unsigned int> where(surfaces->n_pairs(), dealii::numbers::invalid_unsigned_int);
    for (unsigned int s = 0; s < pairing.size(); ++s)
    {
      distance.push_back(contact->distance(state, s));
      const unsigned int p = surfaces->pair(s);
      if (surfaces->is_owned(s) && surfaces->has_status(s) && pairing[s].found && distance[s] > deepest[p])
      {
        deepest[p] = distance[s];
        where[p]   = s;
      }
    }
    for (unsigned int p = 0; p < surfaces->n_pairs(); ++p)
    {
      const auto        &pair  = parameters.contact_pairs[p];
      const double       limit = pair.overclosure_limit > 0. ? pair.overclosure_limit : 0.5 * surfaces->face_size(p);
      const auto         worst = dealii::Utilities::MPI::min_max_avg(deepest[p], communicator);
      const bool         here  = dealii::Utilities::MPI::this_mpi_process(communicator) == worst.max_index;
      const std::string  locus = site_locus(here ? where[p] : dealii::numbers::invalid_unsigned_int);
      std::ostringstream message;
      message << "the bodies overlap at the start: " << locus << " is " << worst.max
              << " inside the master, the limit is " << limit << "; move the bodies apart, or raise 'Contact pair "
              << p + 1 << "/Overclosure limit' if this is meant";
      if (worst.max > limit)
        throw InputError(message.str());
    }
    status->initialize(pairing, distance);
  }
} // namespace Nodus
