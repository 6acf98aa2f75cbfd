#include "contact/facets.h"
#include "base/deal_ii_versions.h"
#include "contact/surface.h"
#include "mesh/bodies.h"
#include "mesh/region.h"
#include "parameters/general_contact.h"

#include <deal.II/base/mpi.h>

namespace Nodus
{
  namespace
  {
    /// Facets of a curved surface rise by more than this part of a face: they meet at a degree or more.
    constexpr double seen_rise = 2e-3;
  } // namespace

  std::vector<std::string> sides_that_stay_facets(const Parameters           &parameters,
                                                  const ContactSurfaces      &surfaces,
                                                  const ContactGeometry      &geometry,
                                                  const Bodies               &bodies,
                                                  const dealii::Mapping<dim> &mapping)
  {
    const auto is_plane = [&](const Bodies::Triangulation::cell_iterator &cell)
    {
      return !parameters.bodies[cell->material_id()].mesh_file.empty() && !bodies.is_curved(cell) &&
             (parameters.degree > 1 || cell->level() > 0);
    };
    const MPI_Comm           communicator = communicator_of(bodies.triangulation());
    std::vector<std::string> sentences;
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      const ContactPairParameters &pair = parameters.contact_pairs[p];
      for (const SurfaceSide side : {slave_side, master_side})
      {
        const RegionParameters master = pair.self_contact ? master_alone(pair) : pair.master;
        if (side == master_side && (pair.has_rigid_master() || master.bodies.empty()))
          continue;
        const std::string label =
            pair_label(parameters.contact_pairs, p) + (side == slave_side ? ", slave" : ", master");
        const Region region(side == slave_side ? pair.slave : master, bodies, label);
        unsigned int body = 0; // of the facets, counted from 1
        for (const auto &cell : bodies.triangulation().active_cell_iterators())
          if (cell->is_locally_owned() && is_plane(cell))
            for (const unsigned int f : cell->face_indices())
              if (region.selects_face(mapping, cell, f))
                body = std::max<unsigned int>(body, cell->material_id() + 1);
        const SurfaceGeometry &shape = (side == slave_side ? geometry.slave : geometry.master)[p];
        const double           size  = side == slave_side ? surfaces.face_size(p) : surfaces.master_face_size(p);
        body                         = dealii::Utilities::MPI::max(body, communicator);
        if (body > 0 && dealii::Utilities::MPI::max(shape.bulge(), communicator) > seen_rise * size)
          sentences.push_back(label + ": the surface is curved, but the mesh file of body " + std::to_string(body) +
                              " (" + bodies.name(body - 1) +
                              ") is of first order: refined faces and those of degree 2 stay as plane as they are in "
                              "the file, and touch at their edges; save it with second order (gmsh -order 2)");
      }
    }
    return sentences;
  }
} // namespace Nodus
