#include "contact/site_values.h"
#include "mesh/sides.h"
#include "parallel/largest.h"
#include "run/judge.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace Nodus
{
  namespace
  {
    using Scheme = ContactPairParameters::Scheme;

    // Depths are parts of the mean face of the side with the smaller ones.
    /// The largest depth of all, with what facets of curved surfaces may overlap by: the arcs that they cut off. The
    /// other depths are without that.
    constexpr double largest_depth = 0.25;
    /// In a pair without a closed site nothing may be pressed in.
    constexpr double tolerated_unseen_depth = 0.05;
    /// An integration point may be that deep, for closed ones keep their distance in the mean alone.
    constexpr double tolerated_point_depth = 0.05;
    /// A node may be that deep where there is contact. Points hold what is between them best; smaller faces of a master
    /// come in between the nodes of the nodal scheme; where means are held corners of the slave may be off, but nodes
    /// of the master, which the means are taken over, less so.
    double tolerated_depth(const Scheme scheme, const SurfaceSide side)
    {
      switch (scheme)
      {
        case Scheme::integration_point:
          return 0.1;
        case Scheme::nodal:
          return 0.2;
        case Scheme::averaged:
          return side == slave_side ? largest_depth : 0.1;
      }
      return 0.;
    }
    /// Of the mean face of the side with the larger ones, where displacements of both sides are prescribed: facets of
    /// curved surfaces overlap a little.
    constexpr double tolerated_held_depth = 1e-2, tolerated_held_slip = 1e-6;

    /// What the surfaces of a pair overlap by without a fault.
    struct Overlap
    {
      double                adjusted = 0.;  ///< they are apart or inside by intent [length]
      std::array<double, 2> rise{{0., 0.}}; ///< of arcs over their facets, for slave and for master nodes [length]
      unsigned int          closed = 0;     ///< sites
    };

    /// @p geometry: as the surfaces are, or were made, if their arcs then are to count.
    std::vector<Overlap> allowed_overlaps(const std::vector<ContactPairParameters> &pairs,
                                          const ContactInterface                   &contact,
                                          const ContactGeometry                    &geometry,
                                          const std::vector<double>                &overclosures,
                                          const MPI_Comm                            communicator)
    {
      const ContactSurfaces    &surfaces = contact.surfaces();
      std::vector<double>       lengths(3 * surfaces.n_pairs(), 0.); // adjustment, slave bulge, master bulge
      std::vector<unsigned int> closed(surfaces.n_pairs(), 0);
      for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      {
        const unsigned int p        = surfaces.pair(s);
        double            &adjusted = lengths[3 * p];
        adjusted = std::max(adjusted, std::abs(contact.status().adjustment(s)) + std::max(overclosures[s], 0.));
        closed[p] += surfaces.is_owned(s) && surfaces.has_status(s) && contact.status().contact(s);
      }
      for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
      {
        lengths[3 * p + 1] = geometry.slave[p].bulge();
        lengths[3 * p + 2] = geometry.master[p].bulge();
      }
      dealii::Utilities::MPI::max(lengths, communicator, lengths);
      dealii::Utilities::MPI::sum(closed, communicator, closed);
      for (unsigned int p = 0; p < surfaces.n_pairs(); ++p) // both passes see the same surfaces
        if (const auto &second = pairs[p].second_pass)
        {
          closed[second->of] += closed[p];
          closed[p] = closed[second->of];
        }

      std::vector<Overlap> overlaps;
      for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
      {
        const double *const length = lengths.data() + 3 * p;
        // smaller faces of a master bulge over those of the slave, which see their mean
        const double ratio = std::max(1., surfaces.face_size(p) / surfaces.master_face_size(p));
        overlaps.push_back({length[0], {{length[1] + length[2], length[1] + ratio * ratio * length[2]}}, closed[p]});
      }
      return overlaps;
    }
  } // namespace

  /// Where displacements of both sides are prescribed no multiplier can act: neither pressure nor friction is found
  /// there, which is right as long as the sides do not meet, or do not slide.
  void Judge::measure_held(Verdict &verdict) const
  {
    const ContactSurfaces    &surfaces = contact_->surfaces();
    Status::Violation         depth, slip; // their counts are not used
    const std::vector<double> overclosures =
        site_overclosures(surfaces, contact_->status(), contact_->pressure(), contact_->state().lambda);
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      const SitePairing &pairing = contact_->pairing()[s];
      const unsigned int p       = surfaces.pair(s);
      if (!surfaces.is_owned(s) || !surfaces.has_status(s) ||
          model_.parameters.contact_pairs[p].contact_law == ContactPairParameters::ContactLaw::tied)
        continue;
      const auto raise = [&](Status::Violation &violation, const double length)
      {
        if (length / larger_face_[p] > violation.value)
        {
          violation.value = length / larger_face_[p];
          violation.site  = s;
        }
      };
      if (pairing.held)
        raise(depth, contact_->distance(s) - overclosures[s]); // > 0: inside
      else if (pairing.found && contact_->status().contact(s) && contact_->status().friction(s))
        for (unsigned int i = 0; i < 2; ++i)
          if (!pairing.tangent_free[i])
            raise(slip,
                  std::abs(pairing.tangent[i] *
                           prescribed_motion(
                               surfaces, contact_->pairing(), contact_->jump(), contact_->state().increment, s)));
    }
    for (const auto &[measure, of_rank, tolerance] :
         {std::make_tuple(Measure::held_depth, &depth, tolerated_held_depth),
          {Measure::held_slip, &slip, tolerated_held_slip}})
    {
      keep_largest(of_rank->value, of_rank->site, model_.communicator);
      verdict[measure] = {of_rank->value, tolerance, contact_->locus(of_rank->site)};
    }
  }

  void Judge::measure_intrusion(Verdict &verdict)
  {
    ContactSurfaces     &surfaces = contact_->surfaces();
    std::vector<Vector3> before, now;
    surfaces.gather(states_.committed.unknowns.block(0), before);
    surfaces.gather(unknowns_.block(0), now);
    const std::vector<double> overclosures =
        site_overclosures(surfaces, contact_->status(), contact_->pressure(), contact_->state().lambda);
    const std::vector<Overlap> allowed = allowed_overlaps(
        model_.parameters.contact_pairs, *contact_, *contact_->geometry(), overclosures, model_.communicator);
    const std::vector<Status::Violation> points = deepest_points();
    std::vector<double>                  deepest; // that a node may be before it has passed [length]
    for (unsigned int p = 0; p < allowed.size(); ++p)
      deepest.push_back(largest_depth * smaller_face_[p] + allowed[p].adjusted);

    const Increment             &increment  = equilibrium_.increment();
    const std::vector<Intrusion> intrusions = find_intrusions(
        surfaces, surfaces.positions(before), surfaces.positions(now), increment.begin, increment.end, deepest);
    Verdict::Finding &seen = verdict[Measure::penetration], &unseen = verdict[Measure::unseen_depth],
                     &passed = verdict[Measure::passed];
    seen.tolerance           = largest_depth;
    unseen.tolerance         = tolerated_unseen_depth;
    for (unsigned int p = 0; p < intrusions.size(); ++p)
    {
      const auto      &pair      = model_.parameters.contact_pairs[p];
      const Intrusion &intrusion = intrusions[p];
      if (pair.contact_law == ContactPairParameters::ContactLaw::tied)
        continue;
      const auto where = [&](const SurfaceSide side, const Point &X)
      {
        return std::string(side == slave_side ? "slave" : "master") + " node " + coordinates(X) + " of " +
               pair_label(model_.parameters.contact_pairs, p);
      };
      const bool closed = allowed[p].closed > 0;
      const auto raise =
          [&](const double depth, const SurfaceSide side, const double tolerance, const std::string &there)
      {
        Verdict::Finding &finding = closed ? seen : unseen;
        const double      overlap = std::min(allowed[p].rise[side], (largest_depth - tolerance) * smaller_face_[p]);
        const double      value   = (depth - allowed[p].adjusted - overlap) / smaller_face_[p];
        if (value / tolerance > finding.value / finding.tolerance)
          finding = {value, tolerance, there, p};
      };
      for (const SurfaceSide side : {slave_side, master_side})
        raise(intrusion.depth[side],
              side,
              closed ? tolerated_depth(pair.scheme, side) : tolerated_unseen_depth,
              where(side, intrusion.deepest[side]));
      if (pair.scheme == Scheme::integration_point)
        raise(points[p].value, slave_side, tolerated_point_depth, contact_->locus(points[p].site));
      if (intrusion.passed > 0)
        passed.raise(passed.value + intrusion.passed, where(intrusion.first_passed.side, intrusion.first_passed.X), p);
    }
  }

  double Judge::clearance(const unsigned int pair) const
  {
    const ContactSurfaces       &surfaces = contact_->surfaces();
    const auto                  &pairs    = model_.parameters.contact_pairs;
    const ContactPairParameters &keys     = pairs[pair];
    const std::vector<Point>     X        = surfaces.reference_positions(); // a dent is no arc
    const ContactGeometry        as_made(pairs, surfaces, X);
    const std::vector<double>    overclosures =
        site_overclosures(surfaces, contact_->status(), contact_->pressure(), contact_->state().lambda);
    const Overlap allowed = allowed_overlaps(pairs, *contact_, as_made, overclosures, model_.communicator)[pair];
    const bool    facets  = surfaces.degree() == 1 && keys.surface == ContactPairParameters::Surface::faceted;
    const double  nodes   = tolerated_depth(keys.scheme, master_side);
    return allowed.adjusted + (facets ? allowed.rise[master_side] : 0.) +
           0.5 * smaller_face_[pair] *
               (keys.scheme == Scheme::integration_point ? std::min(nodes, tolerated_point_depth) : nodes);
  }

  /// Of each pair the integration point that is deepest behind the master, among those with a partner [length].
  std::vector<Status::Violation> Judge::deepest_points() const
  {
    const ContactSurfaces         &surfaces = contact_->surfaces();
    std::vector<Status::Violation> deepest(surfaces.n_pairs());
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      if (surfaces.is_owned(s) && surfaces.has_status(s) && contact_->pairing()[s].found)
        if (Status::Violation &of_pair = deepest[surfaces.pair(s)]; contact_->distance(s) > of_pair.value)
        {
          of_pair.value = contact_->distance(s);
          of_pair.site  = s;
        }
    for (Status::Violation &of_pair : deepest)
      keep_largest(of_pair.value, of_pair.site, model_.communicator);
    return deepest;
  }
} // namespace Nodus
