#include "contact/pairing.h"
#include "contact/segments.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// A relative motion is free when the unconstrained nodes carry at least this much of the jump's weight: a node on
    /// a symmetry plane that projects slightly inside still moves with the plane.
    constexpr double free_weight = 0.1;
    /// Projection tolerance of sites that have a partner, over that of others.
    constexpr double partner_hysteresis = 2.;
    /// Part of the projection tolerance that surfaces with the same rim may be apart along it.
    constexpr double flush = 0.01;

    /// A SitePairing as sent to other ranks.
    struct PairingRecord
    {
      unsigned int face; ///< number on the whole master surface
      double       xi, eta, normal[dim], tangent[2][dim], friction_scale[2];
      bool         found, tangent_free[2];
    };

    /// The frame around the geometric normal @p direction: tangents are orthogonal to its part in the free directions
    /// and lie in them, so that normal and tangential rows never repeat each other. The normal itself stays as it is:
    /// its held components drop out of the rows, and lambda stays a pressure. found = false when no normal motion is
    /// left. Orthotropic friction turns the tangents to its axes; where the constraints leave one tangent, friction has
    /// the limit of that direction.
    void set_frame(const Vector3               &direction,
                   const std::array<bool, dim> &free,
                   const ContactPairParameters &pair,
                   SitePairing                 &pairing)
    {
      Vector3      n      = direction;
      unsigned int n_free = 0;
      for (unsigned int c = 0; c < dim; ++c)
      {
        n_free += free[c];
        if (!free[c])
          n[c] = 0;
      }
      pairing.normal = direction;
      pairing.found  = n.norm() > free_weight;
      n              = pairing.found ? n / n.norm() : direction;

      // As in Abaqus, the first tangent is the projection of the global x axis, or z where x is nearly normal.
      const unsigned int axis = std::abs(n[0]) > 0.999 ? 2 : 0;
      Vector3            t    = -n[axis] * n;
      t[axis] += 1.;
      const bool orthotropic = pair.second_friction_coefficient > 0.;
      if (orthotropic)
      {
        const Vector3 along = pair.friction_direction / pair.friction_direction.norm();
        if (const Vector3 projected = along - (along * n) * n; projected.norm() > 1e-6)
          t = projected / projected.norm();
      }
      const Vector3 first = t;
      if (pairing.found && n_free == 2)
      {
        Vector3 held;
        for (unsigned int c = 0; c < dim; ++c)
          held[c] = free[c] ? 0. : 1.;
        t = dealii::cross_product_3d(held, n);
      }
      pairing.tangent[0]   = t / t.norm();
      pairing.tangent[1]   = dealii::cross_product_3d(n, pairing.tangent[0]);
      pairing.tangent_free = {{pairing.found && n_free >= 2, pairing.found && n_free == 3}};
      if (orthotropic)
      {
        const double ratio = pair.second_friction_coefficient / pair.friction_coefficient;
        for (unsigned int i = 0; i < 2; ++i)
        {
          const double along        = pairing.tangent[i] * first / first.norm();
          pairing.friction_scale[i] = std::sqrt(along * along + ratio * ratio * (1. - along * along));
        }
      }
    }

    /// Position and averaged outward normal of every site; complete for owned ones.
    struct Sites
    {
      std::vector<Point>   x;
      std::vector<Vector3> normal;

      Sites(const ContactSurfaces &surfaces, const ContactGeometry &geometry)
          : x(surfaces.n_sites())
          , normal(surfaces.n_sites())
      {
        for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
          for (unsigned int f = 0; f < geometry.slave[p].n_faces(); ++f)
          {
            const auto &nodes = geometry.slave[p].face(f).nodes;
            for (unsigned int n = 0; n < nodes.size(); ++n)
            {
              const unsigned int k = surfaces.slave_number(p, nodes[n]);
              if (k == dealii::numbers::invalid_unsigned_int)
                continue; // hangs
              x[k] = geometry.slave[p].positions()[nodes[n]];
              // the faces of a node agree, but across a sharp edge: there the site looks half-way
              normal[k] += geometry.slave[p].nodal_normal(f, n);
            }
          }
        for (unsigned int s = 0; s < x.size(); ++s)
          if (surfaces.is_point(s))
          {
            const SlavePoint &point = surfaces.point(s);
            x[s]                    = geometry.position(surfaces, s);
            normal[s]               = geometry.slave[point.pair].averaged_normal(point.face, point.xi, point.eta);
          }
          else
            normal[s] /= normal[s].norm();
      }
    };

    /// In a fold, the face that is nearest to a node may be another one than those that its gap is averaged over. What
    /// their normals differ by fades in as faces fade out of averages; from there on the mean counts alone (eq. O4).
    void agree_with_mean(const Vector3 &mean, Vector3 &normal, Projection &nearest)
    {
      const double part = facing(normal * mean).part;
      normal            = part * normal + (1. - part) * mean;
      normal /= normal.norm();
      if (part == 0.)
        nearest = Projection();
    }

    /// Whether a point that is @p height over the master and @p overhang beyond its rim, both over what is tolerated,
    /// is beside the body rather than on it. What slid off the rim and sank would be pressed back onto it otherwise.
    bool is_beside(const double overhang, const double height)
    {
      return height < 0. && overhang > flush && std::hypot(overhang, height) > 1.;
    }

    bool is_beside(const MasterSearch &search, const SurfaceGeometry &master, const Projection &nearest, const Point &x)
    {
      const auto &[face, xi, eta] = nearest;
      return is_beside(search.overhang(nearest, x).norm(),
                       (x - master.at(face, xi, eta).x) * master.normal(face, xi, eta) /
                           search.tolerated_overhang(face));
    }

    /// Components in which the slave or the master part of a site's jump may move.
    std::array<bool, dim> free_motion(const ContactSurfaces &surfaces,
                                      const unsigned int     site,
                                      const ContactGeometry &geometry,
                                      const SitePairing     &pairing,
                                      const AveragedJump    &averaged)
    {
      const unsigned int    p = surfaces.pair(site);
      std::array<bool, dim> free;
      for (unsigned int c = 0; c < dim; ++c)
      {
        double     weight = 0.;
        const auto add    = [&](const unsigned int node, const double part)
        {
          if (!surfaces.fixed(node, c))
            weight += std::abs(part);
        };
        if (surfaces.is_point(site))
        {
          const SlavePoint &point = surfaces.point(site);
          const FaceShape   shape(surfaces.degree(), point.xi, point.eta);
          for (unsigned int n = 0; n < shape.n; ++n)
            add(surfaces.slave_faces(p)[point.face].nodes[n], shape.value[n]);
        }
        else
          add(surfaces.slave_nodes()[site].node, 1.);
        if (pairing.master.found())
        {
          const FaceShape shape(surfaces.degree(), pairing.master.xi, pairing.master.eta);
          for (unsigned int n = 0; n < shape.n; ++n)
            add(geometry.master[p].face(pairing.master.face).nodes[n], shape.value[n]);
        }
        else if (!surfaces.is_point(site))
          for (const auto &entry : averaged.row(site).master)
            add(entry.node, entry.weight);
        free[c] = weight > free_weight;
      }
      return free;
    }
  } // namespace

  void Pairing::project(const std::vector<ContactPairParameters> &pairs,
                        const ContactSurfaces                    &surfaces,
                        const ContactGeometry                    &geometry,
                        const AveragedJump                       &averaged)
  {
    const Sites sites(surfaces, geometry);
    sites_.assign(surfaces.n_sites(), SitePairing());
    partnered_.resize(sites_.size(), 0);
    using Normal = ContactPairParameters::Normal;
    for (unsigned int s = 0; s < sites_.size(); ++s)
    {
      if (!surfaces.is_owned(s))
        continue;
      SitePairing       &pairing = sites_[s];
      const unsigned int p       = surfaces.pair(s);
      RigidPoint         rigid;
      const double       tolerance = partnered_[s] ? partner_hysteresis : 1.;
      const bool         averages  = pairs[p].scheme == ContactPairParameters::Scheme::averaged;
      // most of a surface that touches itself is near nothing: then nothing has to be looked for
      if (!surfaces.acts(p) || (geometry.self[p] && averages && !averaged.covered(s)))
        partnered_[s] = false;
      else if (geometry.rigid[p] != nullptr)
        rigid = geometry.closest_on_rigid(p, sites.x[s], sites.normal[s], tolerance);
      else if (surfaces.is_point(s))
      {
        const SlavePoint &point = surfaces.point(s);
        pairing.master =
            geometry.closest_to_face(p, point.face, point.xi, point.eta, sites.x[s], sites.normal[s], tolerance);
      }
      else
        pairing.master =
            geometry.closest_to_node(p, surfaces.slave_nodes()[s].node, sites.x[s], sites.normal[s], tolerance);
      if (!partnered_[s] && pairing.master.found() &&
          is_beside(geometry.search[p], geometry.master[p], pairing.master, sites.x[s]))
        pairing.master = Projection();
      if (!partnered_[s] && rigid.found &&
          is_beside(rigid.overhang / geometry.overhang[p], rigid.height / geometry.overhang[p]))
        rigid.found = false;
      partnered_[s]     = rigid.found || pairing.master.found();
      const bool paired = averages ? averaged.covered(s) : pairing.master.found() || rigid.found;
      // A node of the integration point scheme needs a frame for its multipliers even where its own projection fails.
      const bool carries_frame = paired || (surfaces.has_points(p) && !surfaces.is_point(s));
      Vector3    normal        = sites.normal[s];
      if (pairing.master.found())
      {
        const auto &[face, xi, eta] = pairing.master;
        if (pairs[p].normal == Normal::averaged)
          normal = -geometry.master[p].averaged_normal(face, xi, eta);
        else if (pairs[p].normal == Normal::master_facet)
          normal = -geometry.master[p].facet_normal(face, xi, eta, geometry.search[p].rim(face));
        if (averages && paired && geometry.self[p])
          agree_with_mean(averaged.row(s).normal, normal, pairing.master);
      }
      else if (rigid.found)
      {
        if (pairs[p].normal != Normal::slave)
          normal = -rigid.normal;
      }
      else if (averages && paired)
        normal = averaged.row(s).normal;

      if (carries_frame)
      {
        set_frame(normal, free_motion(surfaces, s, geometry, pairing, averaged), pairs[p], pairing);
        pairing.held = paired && !pairing.found;
        continue;
      }
      set_frame(normal, {{true, true, true}}, pairs[p], pairing);
      pairing.found        = false;
      pairing.tangent_free = {{false, false}};
    }
    share(surfaces);
  }

  void Pairing::share(const ContactSurfaces &surfaces)
  {
    std::vector<PairingRecord> records(sites_.size());
    for (unsigned int s = 0; s < sites_.size(); ++s)
      if (surfaces.is_owned(s))
      {
        const SitePairing &pairing = sites_[s];
        PairingRecord     &record  = records[s];
        record.face  = pairing.master.found() ? surfaces.master_faces(surfaces.pair(s))[pairing.master.face].number
                                              : dealii::numbers::invalid_unsigned_int;
        record.xi    = pairing.master.xi;
        record.eta   = pairing.master.eta;
        record.found = pairing.found;
        for (unsigned int c = 0; c < dim; ++c)
          record.normal[c] = pairing.normal[c];
        for (unsigned int i = 0; i < 2; ++i)
        {
          record.tangent_free[i]   = pairing.tangent_free[i];
          record.friction_scale[i] = pairing.friction_scale[i];
          for (unsigned int c = 0; c < dim; ++c)
            record.tangent[i][c] = pairing.tangent[i][c];
        }
      }
    surfaces.site_exchange().update(records);
    for (unsigned int s = 0; s < sites_.size(); ++s)
      if (!surfaces.is_owned(s))
      {
        const PairingRecord &record  = records[s];
        SitePairing         &pairing = sites_[s];
        const auto          &faces   = surfaces.master_faces(surfaces.pair(s));
        const auto           face    = std::partition_point(
            faces.begin(), faces.end(), [&](const SurfaceFace &f) { return f.number < record.face; });
        if (face != faces.end() && face->number == record.face)
          pairing.master = {static_cast<unsigned int>(face - faces.begin()), record.xi, record.eta};
        pairing.found  = record.found;
        pairing.normal = Vector3(record.normal);
        for (unsigned int i = 0; i < 2; ++i)
        {
          pairing.tangent[i]        = Vector3(record.tangent[i]);
          pairing.tangent_free[i]   = record.tangent_free[i];
          pairing.friction_scale[i] = record.friction_scale[i];
        }
      }
  }
} // namespace Nodus
