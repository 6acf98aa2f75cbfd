#include "contact/contact_error.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Nodus
{
  namespace
  {
    /// Slave faces may be larger than the opposite ones by this much before they are split.
    constexpr double tolerated_size_ratio = 4. / 3.;
    /// Points on the rim of the master surface face it in spite of round-off; over the projection tolerance.
    constexpr double tolerated_overhang = 1e-6;

    /// What slave faces say about master faces, on its way to the owners of these.
    class MasterMarks
    {
    public:
      explicit MasterMarks(const ContactSurfaces &surfaces)
          : surfaces_(surfaces)
      {
      }
      void add(const unsigned int pair, const Projection &master, const double value)
      {
        if (!master.found())
          return;
        const SurfaceFace &face = surfaces_.master_faces(pair)[master.face];
        outgoing_[face.owner].emplace_back(std::make_pair(pair, face.number), value);
      }
      /// Calls f(cell, value). Collective.
      template <typename Function>
      void deliver(const Function &f)
      {
        std::map<std::pair<unsigned int, unsigned int>, std::vector<double>> values; // sums in an order of their own
        for (const auto &[rank, marks] : sparse_exchange(surfaces_.layout().communicator, outgoing_))
          for (const auto &[face, value] : marks)
            values[face].push_back(value);
        for (auto &[face, list] : values)
        {
          std::sort(list.begin(), list.end());
          for (const double value : list)
            f(surfaces_.own_cell(face.first, master_side, face.second), value);
        }
      }

    private:
      using Mark = std::pair<std::pair<unsigned int, unsigned int>, double>; ///< (pair, number of the face), value
      const ContactSurfaces                    &surfaces_;
      std::map<unsigned int, std::vector<Mark>> outgoing_;
    };

    /// The middle of a face, but for a little: what the middle faces is often an edge between master faces, where
    /// round-off would choose one.
    constexpr double middle_xi = 0.51, middle_eta = 0.493;

    /// The point of the master that faces a point of a slave face; on a rigid surface it has no face.
    struct Opposite
    {
      bool       found;
      Projection master;
      Vector3    gap; ///< from the slave to it
    };
    Opposite opposite(const ContactGeometry &geometry,
                      const unsigned int     pair,
                      const unsigned int     face,
                      const double           xi,
                      const double           eta)
    {
      const SurfaceGeometry &slave  = geometry.slave[pair];
      const Point            x      = slave.at(face, xi, eta).x;
      const Vector3          normal = slave.normal(face, xi, eta);
      if (geometry.rigid[pair] != nullptr)
      {
        const RigidPoint point = geometry.closest_on_rigid(pair, x, normal);
        return {point.found, Projection(), point.x - x};
      }
      const Projection master = geometry.closest_to_face(pair, face, xi, eta, x, normal, tolerated_overhang);
      if (!master.found())
        return {false, master, Vector3()};
      return {true, master, geometry.master[pair].at(master.face, master.xi, master.eta).x - x};
    }

    template <typename Function>
    void for_own_faces(const ContactSurfaces &surfaces, const Function &f)
    {
      const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(surfaces.layout().communicator);
      for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
        for (unsigned int i = 0, own = 0; i < surfaces.slave_faces(p).size(); ++i)
          if (surfaces.slave_faces(p)[i].owner == rank)
            f(p, i, own++);
    }
  } // namespace

  void add_contact_error(const double                      weight,
                         const std::vector<double>        &stiffness,
                         const ContactSurfaces            &surfaces,
                         const ContactGeometry            &geometry,
                         const std::vector<ContactFields> &fields,
                         const NodalStress                &stress,
                         RefinementIndicator              &indicator)
  {
    MasterMarks masters(surfaces);
    for_own_faces(surfaces,
                  [&](const unsigned int p, const unsigned int f, const unsigned int own)
                  {
                    const SurfaceFace   &face   = surfaces.slave_faces(p)[f];
                    const ContactFields &field  = fields[p];
                    const auto          &places = field.faces[own];
                    const double         E = stiffness[p], A = geometry.slave[p].at(f, 0.5, 0.5).area_vector().norm();
                    const double         h    = std::sqrt(A);
                    double               jump = 0., traction = 0., friction = 0.;
                    bool                 open = false, closed = false, stick = false, slip = false;
                    for (unsigned int n = 0; n < places.size(); ++n)
                    {
                      const unsigned int i = places[n];
                      // a node at the rim of the master has its pressure on a part of its area; hanging ones have none
                      const double  part = field.area[i] > 0. ? std::min(1., places.size() * field.area[i] / A) : 1.;
                      const Vector3 t    = part * (field.friction[i] - field.pressure[i] * field.normal[i]);
                      const Vector3 bulk = stress.stress(surfaces.nodes()[face.nodes[n]].dofs[0]) * field.normal[i];
                      if (field.paired[i])
                        jump += (t - bulk).norm_square() / places.size();
                      traction = std::max(traction, t.norm_square());
                      friction = std::max(friction, part * part * field.friction[i].norm_square());
                      open     = open || field.status[i] == ContactStatus::open;
                      closed   = closed || field.status[i] != ContactStatus::open;
                      stick    = stick || field.status[i] == ContactStatus::stick;
                      slip     = slip || field.status[i] == ContactStatus::slip;
                    }
                    const Opposite middle = opposite(geometry, p, f, middle_xi, middle_eta);
                    double         sum    = closed ? jump : 0.;
                    if (open && closed)
                      sum += traction;
                    if (stick && slip)
                      sum += 0.25 * friction;
                    if (middle.found && closed)
                    {
                      const double gap = middle.gap * geometry.slave[p].normal(f, middle_xi, middle_eta);
                      if (!open || gap < 0.)
                        sum += E * E * gap * gap / A;
                    }
                    const double value = weight * h * A / E * sum;
                    indicator.squared_error[face.cell] += value;
                    if (value > 0.)
                      masters.add(p, middle.master, value);
                  });
    masters.deliver([&](const unsigned int cell, const double value) { indicator.squared_error[cell] += value; });
  }

  std::vector<double> largest_contact_pressure(const ContactSurfaces            &surfaces,
                                               const ContactGeometry            &geometry,
                                               const std::vector<ContactFields> &fields,
                                               const unsigned int                n_cells)
  {
    std::vector<double> largest(n_cells, 0.);
    const auto          note = [&](const unsigned int cell, const double pressure)
    { largest[cell] = std::max(largest[cell], pressure); };
    MasterMarks masters(surfaces);
    for_own_faces(surfaces,
                  [&](const unsigned int p, const unsigned int f, const unsigned int own)
                  {
                    double pressure = 0.;
                    for (const unsigned int i : fields[p].faces[own])
                      pressure = std::max(pressure, fields[p].pressure[i]);
                    note(surfaces.slave_faces(p)[f].cell, pressure);
                    if (pressure > 0.)
                      masters.add(p, opposite(geometry, p, f, middle_xi, middle_eta).master, pressure);
                  });
    masters.deliver(note);
    return largest;
  }

  void
  mark_coarse_slaves(const ContactSurfaces &surfaces, const ContactGeometry &geometry, RefinementIndicator &indicator)
  {
    for_own_faces(surfaces,
                  [&](const unsigned int p, const unsigned int f, unsigned int)
                  {
                    const Projection master = opposite(geometry, p, f, middle_xi, middle_eta).master;
                    if (!master.found())
                      return;
                    const auto size = [](const SurfaceGeometry &side, const unsigned int face)
                    { return std::sqrt(side.at(face, 0.5, 0.5).area_vector().norm()); };
                    if (size(geometry.slave[p], f) > tolerated_size_ratio * size(geometry.master[p], master.face))
                      indicator.refine[surfaces.slave_faces(p)[f].cell] = 1;
                  });
  }

  void mark_near_contact(const std::vector<double> &distance,
                         const ContactSurfaces     &surfaces,
                         const ContactGeometry     &geometry,
                         RefinementIndicator       &indicator)
  {
    MasterMarks masters(surfaces);
    for_own_faces(surfaces,
                  [&](const unsigned int p, const unsigned int f, unsigned int)
                  {
                    const double limit = distance[p] > 0. ? distance[p] : surfaces.face_size(p);
                    for (unsigned int i = 0; i < 9; ++i)
                    {
                      const double   xi = 0.5 * (i % 3), eta = 0.5 * (i / 3);
                      const Opposite point = opposite(geometry, p, f, xi, eta);
                      if (!point.found || point.gap.norm() > limit)
                        continue;
                      indicator.refine[surfaces.slave_faces(p)[f].cell] = 1;
                      masters.add(p, point.master, 1.);
                    }
                  });
    masters.deliver([&](const unsigned int cell, double) { indicator.refine[cell] = 1; });
  }
} // namespace Nodus
